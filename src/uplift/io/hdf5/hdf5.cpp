#include "uplift/io/hdf5/hdf5.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "uplift/base/error.h"
#include "uplift/base/text.h"
#include "uplift/io/hdf5/library.h"

namespace uplift {
namespace {

constexpr std::uint64_t deflate_at_best = 1032;  // bytes from one (zlib's technical notes), so no chunk justifies more
constexpr std::uint64_t chunk_for_nothing = std::uint64_t{1} << 20;
constexpr std::size_t longest_text = 4096;

herr_t take_name(hid_t, const char* name, const H5L_info_t* link, void* names) {
  if (link->type == H5L_TYPE_HARD) static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

herr_t take_reason(unsigned number, const H5E_error2_t* error, void* text) {
  if (number == 0 && error->desc) *static_cast<std::string*>(text) = error->desc;
  return 0;
}

std::string type_name(hid_t type) {
  switch (H5Tget_class(type)) {
    case H5T_INTEGER:
      return "integers";
    case H5T_FLOAT:
      return "floating-point numbers";
    case H5T_STRING:
      return "text";
    case H5T_COMPOUND:
      return "records";
    case H5T_ARRAY:
      return "arrays";
    default:
      return "another type";
  }
}

bool known_filters(hid_t properties) {
  const int filters = H5Pget_nfilters(properties);
  for (int i = 0; i < filters; ++i) {
    unsigned flags = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter = H5Pget_filter2(properties, static_cast<unsigned>(i), &flags, &values, nullptr, 0, nullptr, nullptr);
    if (filter != H5Z_FILTER_DEFLATE && filter != H5Z_FILTER_SHUFFLE && filter != H5Z_FILTER_FLETCHER32 && filter != H5Z_FILTER_SZIP)
      return false;
  }
  return filters >= 0;
}

/// HDF5 can describe numbers of any number of bits; only those of real machines are converted here. None is shorter than 4 bytes, so that
/// numbers take at most twice as much memory as the data that they come from.
bool standard_integers(hid_t type) {
  const std::array<hid_t, 8> known{H5T_STD_I32LE, H5T_STD_I64LE, H5T_STD_U32LE, H5T_STD_U64LE,
                                   H5T_STD_I32BE, H5T_STD_I64BE, H5T_STD_U32BE, H5T_STD_U64BE};
  return std::any_of(known.begin(), known.end(), [&](hid_t one) { return H5Tequal(type, one) > 0; });
}
bool standard_floats(hid_t type) {
  const std::array<hid_t, 4> known{H5T_IEEE_F32LE, H5T_IEEE_F64LE, H5T_IEEE_F32BE, H5T_IEEE_F64BE};
  return std::any_of(known.begin(), known.end(), [&](hid_t one) { return H5Tequal(type, one) > 0; });
}

/// a * b, or the largest number.
std::uint64_t product(std::uint64_t a, std::uint64_t b) {
  std::uint64_t result = 0;
  return __builtin_mul_overflow(a, b, &result) ? UINT64_MAX : result;
}

}  // namespace

Hdf5Id::Hdf5Id(Hdf5Id&& other) noexcept : id_(std::exchange(other.id_, -1)), release_(other.release_) {}

Hdf5Id& Hdf5Id::operator=(Hdf5Id&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(release_, other.release_);
  return *this;
}

Hdf5Id::~Hdf5Id() {
  if (id_ < 0) return;
  const Hdf5Call call;  // a damaged file may fail to close too
  release_(id_);
}

std::recursive_mutex& Hdf5Call::mutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

std::string hdf5_reason() {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_reason, &reason);
  return reason.empty() ? "an error of HDF5" : reason;
}

Hdf5Id hdf5_access(bool in_memory) {
  Hdf5Id properties(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(properties.get(), false, true);  // not every network disk can lock
  constexpr std::size_t grow = std::size_t{1} << 16;
  if (in_memory) H5Pset_fapl_core(properties.get(), grow, false);
  return properties;
}

Hdf5Reader Hdf5Reader::open(const std::string& path) {
  const Hdf5Call call;
  const Hdf5Id access = hdf5_access(false);
  std::error_code error;
  const auto bytes = std::filesystem::file_size(path, error);
  if (error) throw InputError({path, 0}, "", "a file", error.message());
  Hdf5Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
  if (!file.ok()) throw InputError({path, 0}, "", "an HDF5 file", hdf5_reason());
  return {std::move(file), path, bytes};
}

Hdf5Reader Hdf5Reader::from_memory(std::string_view bytes, const std::string& name) {
  const Hdf5Call call;
  const Hdf5Id access = hdf5_access(true);
  // HDF5 copies the image; it takes a pointer that is not const only for its callbacks.
  H5Pset_file_image(access.get(), const_cast<char*>(bytes.data()), bytes.size());
  Hdf5Id file(H5Fopen(name.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
  if (!file.ok()) throw InputError({name, 0}, "", "an HDF5 file", hdf5_reason());
  return {std::move(file), name, bytes.size()};
}

void Hdf5Reader::fail(const std::string& object, const std::string& wanted, const std::string& found) const {
  throw InputError({name_, 0}, object, wanted, found);
}

bool Hdf5Reader::has(const std::string& path) const {
  const Hdf5Call call;
  for (std::size_t at = 0; at != path.npos;) {
    at = path.find('/', at + 1);
    const std::string part = path.substr(0, at);
    H5L_info_t link{};
    if (H5Lexists(file_.get(), part.c_str(), H5P_DEFAULT) <= 0 || H5Lget_info(file_.get(), part.c_str(), &link, H5P_DEFAULT) < 0)
      return false;
    if (link.type != H5L_TYPE_HARD) fail(part, "an object of this file", "a link");
  }
  return true;
}

Hdf5Id Hdf5Reader::object(const std::string& path) const {
  if (!has(path)) fail(path, "this group or data set", "nothing of this name");
  Hdf5Id id(H5Oopen(file_.get(), path.c_str(), H5P_DEFAULT), H5Oclose);
  if (!id.ok()) fail(path, "a group or data set", hdf5_reason());
  return id;
}

std::vector<std::string> Hdf5Reader::children(const std::string& group) const {
  const Hdf5Call call;
  const Hdf5Id id = object(group);
  std::vector<std::string> names;
  if (H5Iget_type(id.get()) != H5I_GROUP) fail(group, "a group", "something else");
  if (H5Literate(id.get(), H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, take_name, &names) < 0)
    fail(group, "a group that can be read", hdf5_reason());
  std::sort(names.begin(), names.end());
  return names;
}

std::optional<std::int64_t> Hdf5Reader::integer_attribute(const std::string& path, const std::string& name) const {
  const Hdf5Call call;
  const Hdf5Id id = object(path);
  if (H5Aexists(id.get(), name.c_str()) <= 0) return std::nullopt;
  const Hdf5Id attribute(H5Aopen(id.get(), name.c_str(), H5P_DEFAULT), H5Aclose);
  const Hdf5Id type(H5Aget_type(attribute.get()), H5Tclose), space(H5Aget_space(attribute.get()), H5Sclose);
  const bool one =
      attribute.ok() && type.ok() && space.ok() && standard_integers(type.get()) && H5Sget_simple_extent_npoints(space.get()) == 1;
  std::int64_t value = 0;
  if (!one || H5Aread(attribute.get(), H5T_NATIVE_INT64, &value) < 0)
    fail(path, "an integer in attribute " + in_quotes(name), "something else");
  return value;
}

Hdf5Id Hdf5Reader::data(const std::string& path) const {
  Hdf5Id id = object(path);
  if (H5Iget_type(id.get()) != H5I_DATASET) fail(path, "a data set", "something else");
  check_storage(path, id);
  return id;
}

/// What the data set claims must be there: plain data byte for byte, compressed data within what deflate can do.
void Hdf5Reader::check_storage(const std::string& path, const Hdf5Id& data) const {
  const Hdf5Id properties(H5Dget_create_plist(data.get()), H5Pclose), type(H5Dget_type(data.get()), H5Tclose);
  if (!properties.ok() || !type.ok()) fail(path, "a data set", hdf5_reason());
  const std::uint64_t wanted = product(items(path, data), H5Tget_size(type.get())), stored = H5Dget_storage_size(data.get());
  const H5D_layout_t layout = H5Pget_layout(properties.get());
  std::uint64_t held = stored;
  if (layout == H5D_CHUNKED) {
    std::array<hsize_t, H5S_MAX_RANK> lengths{};
    const int rank = H5Pget_chunk(properties.get(), H5S_MAX_RANK, lengths.data());
    std::uint64_t chunk = rank < 0 ? UINT64_MAX : H5Tget_size(type.get());
    for (int i = 0; i < rank; ++i) chunk = product(chunk, lengths[static_cast<std::size_t>(i)]);
    if (H5Pget_nfilters(properties.get()) > 0) held = product(stored, deflate_at_best);
    if (chunk > std::max(held, chunk_for_nothing)) fail(path, "chunks that the file can hold", std::to_string(chunk) + " bytes each");
    if (!known_filters(properties.get())) fail(path, "data that are plain or compressed by deflate or szip", "another filter");
  } else if (layout == H5D_VIRTUAL || H5Pget_external_count(properties.get()) != 0) {
    fail(path, "data in this file", "data in another one");
  }
  if (stored > bytes_ || wanted > held)
    fail(path, std::to_string(wanted) + " bytes of data", std::to_string(stored) + " bytes in a file of " + std::to_string(bytes_));
}

std::uint64_t Hdf5Reader::items(const std::string& path, const Hdf5Id& data) const {
  const Hdf5Id space(H5Dget_space(data.get()), H5Sclose);
  const hssize_t count = space.ok() ? H5Sget_simple_extent_npoints(space.get()) : -1;
  if (count < 0) fail(path, "a data set with a size", hdf5_reason());
  return static_cast<std::uint64_t>(count);
}

std::vector<std::int64_t> Hdf5Reader::shape(const std::string& path) const {
  const Hdf5Call call;
  const Hdf5Id id = data(path), space(H5Dget_space(id.get()), H5Sclose);
  std::array<hsize_t, H5S_MAX_RANK> lengths{};
  const int rank = H5Sget_simple_extent_dims(space.get(), lengths.data(), nullptr);
  if (rank < 0) fail(path, "a data set with a size", hdf5_reason());
  return {lengths.begin(), lengths.begin() + rank};
}

void Hdf5Reader::read(const std::string& path, const Hdf5Id& data, std::int64_t memory_type, void* to) const {
  if (H5Dread(data.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, to) < 0) fail(path, "data that can be read", hdf5_reason());
}

std::vector<int> Hdf5Reader::integers(const std::string& path) const {
  const Hdf5Call call;
  const Hdf5Id id = data(path), type(H5Dget_type(id.get()), H5Tclose);
  if (!standard_integers(type.get())) fail(path, "integers of 4 or 8 bytes", type_name(type.get()));
  std::vector<int> values(items(path, id));
  if (!values.empty()) read(path, id, H5T_NATIVE_INT, values.data());
  return values;
}

std::vector<double> Hdf5Reader::numbers(const std::string& path) const {
  const Hdf5Call call;
  const Hdf5Id id = data(path), type(H5Dget_type(id.get()), H5Tclose);
  if (!standard_floats(type.get()) && !standard_integers(type.get())) fail(path, "numbers of 4 or 8 bytes", type_name(type.get()));
  std::vector<double> values(items(path, id));
  if (!values.empty()) read(path, id, H5T_NATIVE_DOUBLE, values.data());
  return values;
}

std::vector<std::string> Hdf5Reader::texts(const std::string& path) const {
  const Hdf5Call call;
  const Hdf5Id id = data(path), type(H5Dget_type(id.get()), H5Tclose);
  const std::size_t length = H5Tget_size(type.get());
  const H5T_class_t kind = H5Tget_class(type.get());
  const Hdf5Id base(kind == H5T_ARRAY ? H5Tget_super(type.get()) : -1, H5Tclose);
  const bool bytes = base.ok() && H5Tget_class(base.get()) == H5T_INTEGER && H5Tget_size(base.get()) == 1;
  const bool text = kind == H5T_STRING && H5Tis_variable_str(type.get()) == 0;
  if ((!bytes && !text) || length == 0 || length > longest_text)
    fail(path, "texts of a fixed length up to " + std::to_string(longest_text), type_name(type.get()));
  std::string all(items(path, id) * length, '\0');
  if (!all.empty()) read(path, id, type.get(), all.data());
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < all.size(); at += length) {
    const std::string one = all.substr(at, length);
    texts.push_back(one.substr(0, one.find('\0')));
  }
  return texts;
}

}  // namespace uplift
