// MED files: a mesh whose parts fit together, or an InputError. See README.md. The first byte decides:
// - an HDF5 file ("\x89HDF") is read as it is, by a process of its own, as users' files are: libhdf5 may crash there, this process may not;
// - "M" and "W": what such a process would send back;
// - all other bytes choose what stands where in a sound HDF5 file: objects that are missing or of another kind, types, lengths, storage and
//   contents. It is read here. (Random bytes of HDF5 would rarely get past the library to our reader.)
#include <fuzzer/FuzzedDataProvider.h>
#include <pthread.h>
#include <sanitizer/common_interface_defs.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz_support.h"
#include "uplift/io/hdf5/library.h"
#include "uplift/io/mesh/med.h"
#include "uplift/io/mesh/med_file.h"
#include "uplift/io/mesh/med_message.h"

// HDF5 asks for what a damaged file says and takes a refusal well; some memory it loses when such a file does not close.
extern "C" const char* __asan_default_options() {
  return "allocator_may_return_null=1:alloc_dealloc_mismatch=0";
}
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libhdf5\n";
}

// What our own code asks for in one piece must be justified by the file: deflate makes at most 1032 bytes of one. (HDF5 itself allocates by
// malloc.)
void* operator new(std::size_t size) {
  constexpr std::size_t most = std::size_t{128} << 20;
  if (size > most) __builtin_trap();
  if (void* memory = std::malloc(size ? size : 1)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace uplift {
namespace {

const std::string step = "/ENS_MAA/m/-0000000000000000001-0000000000000000001";
constexpr std::array<std::string_view, 9> type_names{"PO1", "SE2", "TR6", "QU4", "TE4", "T10", "HE8", "PY5", "XYZ"};

class MadeFile {
 public:
  explicit MadeFile(FuzzedDataProvider& choice) : choice_(choice) {
    const Hdf5Id access = hdf5_access(true);
    file_ = Hdf5Id(H5Fcreate("made.med", H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose);
  }

  std::string image() {
    make("/INFOS_GENERALES", {"MAJ"});
    make("/ENS_MAA", {});
    make("/ENS_MAA/m", {"ESP", "TYP"});
    if (choice_.ConsumeIntegralInRange(0, 15) == 0) make("/ENS_MAA/second", {});
    make(step, {});
    make(step + "/NOE", {});
    make_data(step + "/NOE/COO");
    if (choice_.ConsumeBool()) make_data(step + "/NOE/FAM");
    make(step + "/MAI", {});
    for (int types = choice_.ConsumeIntegralInRange(0, 3); types > 0; --types) {
      const std::string type = step + "/MAI/" + std::string(choice_.PickValueInArray(type_names));
      make(type, {});
      make_data(type + "/NOD");
      if (choice_.ConsumeBool()) make_data(type + "/FAM");
    }
    for (const std::string kind : {"/FAS/m/ELEME", "/FAS/m/NOEUD"})
      for (int families = choice_.ConsumeIntegralInRange(0, 2); families > 0; --families) {
        const std::string family = kind + "/FAM" + std::to_string(families);
        make(family, {"NUM"});
        if (choice_.ConsumeBool()) make_data(family + "/GRO/NOM");
      }
    H5Fflush(file_.get(), H5F_SCOPE_GLOBAL);
    std::string bytes(static_cast<std::size_t>(std::max<ssize_t>(H5Fget_file_image(file_.get(), nullptr, 0), 0)), '\0');
    H5Fget_file_image(file_.get(), bytes.data(), bytes.size());
    return bytes;
  }

 private:
  bool seldom() { return choice_.ConsumeIntegralInRange(0, 31) == 0; }

  void make(const std::string& path, const std::vector<std::string>& attributes) {
    if (seldom()) return;
    if (seldom()) return make_data(path);
    const Hdf5Id parents(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(parents.get(), 1);
    const Hdf5Id group(H5Gcreate2(file_.get(), path.c_str(), parents.get(), H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    for (const std::string& name : attributes) attach(group, name);
  }

  void attach(const Hdf5Id& object, const std::string& name) {
    if (seldom()) return;
    const hsize_t two = 2;
    const Hdf5Id space(seldom() ? H5Screate_simple(1, &two, nullptr) : H5Screate(H5S_SCALAR), H5Sclose);
    const hid_t type = seldom() ? H5T_IEEE_F64LE : choice_.ConsumeBool() ? H5T_STD_I32LE : H5T_STD_I64BE;
    const Hdf5Id made(H5Acreate2(object.get(), name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    const int few = choice_.ConsumeIntegralInRange(-1, 4);
    const std::array<std::int64_t, 2> values{seldom() ? choice_.ConsumeIntegral<std::int64_t>() : few, 0};
    H5Awrite(made.get(), type == H5T_IEEE_F64LE ? type : H5T_NATIVE_INT64, values.data());
  }

  Hdf5Id type() {
    const std::array<hid_t, 8> plain{H5T_STD_I32LE, H5T_STD_I64LE, H5T_IEEE_F64LE, H5T_IEEE_F32BE,
                                     H5T_STD_U8LE,  H5T_STD_I16BE, H5T_C_S1,       H5T_STD_REF_OBJ};
    Hdf5Id made(H5Tcopy(plain[choice_.ConsumeIntegralInRange<std::size_t>(0, plain.size() - 1)]), H5Tclose);
    const hsize_t length = choice_.PickValueInArray<hsize_t>({80, 80, 1, 5000});
    switch (choice_.ConsumeIntegralInRange(0, 7)) {
      case 0:
        return {H5Tarray_create2(made.get(), 1, &length), H5Tclose};
      case 1:
        H5Tset_size(made.get(), choice_.PickValueInArray<std::size_t>({80, 3, 8, H5T_VARIABLE}));
        return made;
      case 2:
        H5Tset_precision(made.get(), choice_.ConsumeIntegralInRange<std::size_t>(1, 40));
        return made;
      default:
        return made;
    }
  }

  void make_data(const std::string& path) {
    if (seldom()) return;
    std::array<hsize_t, 3> lengths{}, chunk{};
    const int rank = choice_.ConsumeIntegralInRange(0, 7) < 6 ? 1 : choice_.ConsumeIntegralInRange(0, 3);
    for (hsize_t& length : lengths) length = seldom() ? choice_.ConsumeIntegral<hsize_t>() : choice_.ConsumeIntegralInRange<hsize_t>(0, 24);
    for (hsize_t& length : chunk)
      length = seldom() ? choice_.ConsumeIntegral<std::uint32_t>() : choice_.ConsumeIntegralInRange<hsize_t>(1, 9);
    const Hdf5Id parents(H5Pcreate(H5P_LINK_CREATE), H5Pclose), storage(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(parents.get(), 1);
    const bool chunked = rank > 0 && choice_.ConsumeIntegralInRange(0, 3) == 0;
    if (chunked) H5Pset_chunk(storage.get(), rank, chunk.data());
    if (chunked && choice_.ConsumeBool()) H5Pset_deflate(storage.get(), 1);
    const Hdf5Id space(H5Screate_simple(rank, lengths.data(), nullptr), H5Sclose), own_type = type();
    const Hdf5Id data(H5Dcreate2(file_.get(), path.c_str(), own_type.get(), space.get(), parents.get(), storage.get(), H5P_DEFAULT),
                      H5Dclose);
    if (seldom()) attach(data, "NBR");
    fill(data, own_type, H5Sget_simple_extent_npoints(space.get()), chunk, rank);
  }

  /// Contents, small numbers mostly; large claims stay empty.
  void fill(const Hdf5Id& data, const Hdf5Id& own_type, hssize_t count, const std::array<hsize_t, 3>& chunk, int rank) {
    constexpr std::size_t most = 20000;
    for (int k = 0; k < rank; ++k)
      if (chunk[static_cast<std::size_t>(k)] > most) return;
    const std::size_t size = H5Tget_size(own_type.get());
    if (!data.ok() || count <= 0 || size == 0 || static_cast<std::size_t>(count) > most / size) return;
    if (H5Tis_variable_str(own_type.get()) > 0 || H5Tget_class(own_type.get()) == H5T_REFERENCE || seldom()) return;
    std::vector<char> bytes(static_cast<std::size_t>(count) * size);
    const bool letters = choice_.ConsumeBool();
    for (std::size_t i = 0; i < bytes.size(); ++i)
      bytes[i] = letters    ? static_cast<char>('a' + i / 80 % 3)
                 : i % size ? '\0'
                            : static_cast<char>(choice_.ConsumeIntegralInRange(-2, 12));
    H5Dwrite(data.get(), own_type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data());
  }

  FuzzedDataProvider& choice_;
  Hdf5Id file_;
};

template <class Read>
void check(const Read& read) {
  try {
    require_consistent(read());
  } catch (const InputError&) {
  }
}

std::string made(const std::uint8_t* data, std::size_t size) {
  const Hdf5Call call;
  FuzzedDataProvider choice(data, size);
  return MadeFile(choice).image();
}

}  // namespace
}  // namespace uplift

/// A crash of the other process is expected, and is not to be reported as one of the fuzzer.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  return pthread_atfork(nullptr, nullptr, [] { __sanitizer_set_death_callback(nullptr); });
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace uplift;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  if (bytes.starts_with("\x89HDF"))
    check([&] { return read_med_bytes(bytes, "fuzz.med"); });
  else if (bytes.starts_with("M") || bytes.starts_with("W"))
    check([&] { return mesh_of_message(bytes, {"fuzz.med", 0}); });
  else
    check([&] { return read_med(Hdf5Reader::from_memory(made(data, size), "fuzz.med")); });
  return 0;
}
