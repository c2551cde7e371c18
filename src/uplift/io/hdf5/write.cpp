#include <cassert>
#include <numeric>

#include "uplift/base/error.h"
#include "uplift/io/hdf5/hdf5.h"
#include "uplift/io/hdf5/library.h"

namespace uplift {

Hdf5Writer Hdf5Writer::create(const std::string& path) {
  const Hdf5Call call;
  const Hdf5Id access = hdf5_access(false);
  Hdf5Id file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose);
  if (!file.ok()) throw InputError({path, 0}, "", "a file that can be written", hdf5_reason());
  return {std::move(file), path};
}

Hdf5Writer Hdf5Writer::in_memory() {
  const Hdf5Call call;
  const Hdf5Id access = hdf5_access(true);
  const std::string name = "memory" + std::to_string(access.get()) + ".h5";  // HDF5 takes files of one name for one file
  Hdf5Id file(H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose);
  if (!file.ok()) throw InputError({name, 0}, "", "memory for a file", hdf5_reason());
  return {std::move(file), name};
}

void Hdf5Writer::fail(const std::string& object) const {
  throw InputError({name_, 0}, object, "a file that can be written", hdf5_reason());
}

void Hdf5Writer::group(const std::string& path) {
  const Hdf5Call call;
  for (std::size_t at = 0; at != path.npos;) {
    at = path.find('/', at + 1);
    const std::string part = path.substr(0, at);
    if (part.empty() || part == "/" || H5Lexists(file_.get(), part.c_str(), H5P_DEFAULT) > 0) continue;
    const Hdf5Id made(H5Gcreate2(file_.get(), part.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    if (!made.ok()) fail(part);
  }
}

void Hdf5Writer::write(const std::string& path, std::int64_t file_type, std::int64_t memory_type, const void* values, std::size_t count,
                       std::span<const std::int64_t> shape) {
  const std::vector<hsize_t> lengths(shape.begin(), shape.end());
  [[maybe_unused]] const hsize_t product = std::accumulate(lengths.begin(), lengths.end(), hsize_t{1}, std::multiplies<>());
  assert(product == count && "the shape of a data set");
  group(path.substr(0, path.rfind('/')));
  const Hdf5Call call;
  assert(H5Lexists(file_.get(), path.c_str(), H5P_DEFAULT) <= 0 && "a data set is written once");
  const Hdf5Id space(H5Screate_simple(static_cast<int>(lengths.size()), lengths.data(), nullptr), H5Sclose);
  const Hdf5Id properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties.get(), false);  // the bytes of the file depend on its content alone
  const Hdf5Id data(H5Dcreate2(file_.get(), path.c_str(), file_type, space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT), H5Dclose);
  if (!data.ok() || (count > 0 && H5Dwrite(data.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0)) fail(path);
}

void Hdf5Writer::numbers(const std::string& data, std::span<const double> values, std::span<const std::int64_t> shape) {
  const Hdf5Call call;
  write(data, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values.data(), values.size(), shape);
}
void Hdf5Writer::numbers(const std::string& data, std::span<const float> values, std::span<const std::int64_t> shape) {
  const Hdf5Call call;
  write(data, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, values.data(), values.size(), shape);
}
void Hdf5Writer::integers(const std::string& data, std::span<const int> values, std::span<const std::int64_t> shape) {
  const Hdf5Call call;
  write(data, H5T_STD_I32LE, H5T_NATIVE_INT, values.data(), values.size(), shape);
}

void Hdf5Writer::attach(const std::string& object, const std::string& name, std::int64_t file_type, std::int64_t memory_type,
                        const void* value) {
  const Hdf5Id to(H5Oopen(file_.get(), object.c_str(), H5P_DEFAULT), H5Oclose), space(H5Screate(H5S_SCALAR), H5Sclose);
  assert(to.ok() && "an attribute of an object that was written");
  const Hdf5Id made(H5Acreate2(to.get(), name.c_str(), file_type, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!made.ok() || H5Awrite(made.get(), memory_type, value) < 0) fail(object);
}

void Hdf5Writer::attribute(const std::string& object, const std::string& name, int value) {
  const Hdf5Call call;
  attach(object, name, H5T_STD_I32LE, H5T_NATIVE_INT, &value);
}
void Hdf5Writer::attribute(const std::string& object, const std::string& name, double value) {
  const Hdf5Call call;
  attach(object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}
void Hdf5Writer::attribute(const std::string& object, const std::string& name, std::string_view text) {
  const Hdf5Call call;
  const Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), text.size() + 1);
  attach(object, name, type.get(), type.get(), std::string(text).c_str());
}

void Hdf5Writer::flush() {
  const Hdf5Call call;
  if (H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) < 0) fail("");
}

std::string Hdf5Writer::image() {
  flush();
  const Hdf5Call call;
  const ssize_t size = H5Fget_file_image(file_.get(), nullptr, 0);
  std::string bytes(size > 0 ? static_cast<std::size_t>(size) : 0, '\0');
  if (size <= 0 || H5Fget_file_image(file_.get(), bytes.data(), bytes.size()) != size) fail("");
  return bytes;
}

}  // namespace uplift
