#pragma once
#if __has_include(<hdf5.h>)
#include <hdf5.h>
#else
#include <hdf5/serial/hdf5.h>  // Debian's place
#endif

#include "uplift/io/hdf5/hdf5.h"

// For hdf5.cpp and hdf5_write.cpp.
namespace uplift {

static_assert(sizeof(hid_t) == sizeof(std::int64_t), "HDF5 1.10 or later");

/// HDF5 prints its errors by default: not while this lives. Nor may it clean up when the process ends, which it cannot after a damaged file
/// and says so on the terminal: every object is released by its owner.
class Hdf5Quiet {
 public:
  Hdf5Quiet() {
    H5dont_atexit();
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Hdf5Quiet() {
    H5Eclear2(H5E_DEFAULT);
    H5Eset_auto2(H5E_DEFAULT, print_, data_);
  }
  Hdf5Quiet(const Hdf5Quiet&) = delete;
  Hdf5Quiet& operator=(const Hdf5Quiet&) = delete;

 private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

/// What HDF5 says about the last error: its innermost message.
std::string hdf5_reason();

/// Properties for opening or making a file: no locks, or in memory when `image` is wanted.
Hdf5Id hdf5_access(bool in_memory);

}  // namespace uplift
