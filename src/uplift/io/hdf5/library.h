#pragma once
#if __has_include(<hdf5.h>)
#include <hdf5.h>
#else
#include <hdf5/serial/hdf5.h>  // Debian's place
#endif

#include <mutex>

#include "uplift/io/hdf5/hdf5.h"

// For hdf5.cpp and write.cpp.
namespace uplift {

static_assert(sizeof(hid_t) == sizeof(std::int64_t), "HDF5 1.10 or later");

/// One call of HDF5 at a time, without its voice: Debian's library is not safe in threads, and prints its errors by default. Nor may it
/// clean up when the process ends, which it cannot after a damaged file and says so on the terminal: every object is released by its owner.
class Hdf5Call {
 public:
  Hdf5Call() : alone_(mutex()) {
    H5dont_atexit();
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Hdf5Call() {
    H5Eclear2(H5E_DEFAULT);
    H5Eset_auto2(H5E_DEFAULT, print_, data_);
  }
  Hdf5Call(const Hdf5Call&) = delete;
  Hdf5Call& operator=(const Hdf5Call&) = delete;

 private:
  static std::recursive_mutex& mutex();

  std::lock_guard<std::recursive_mutex> alone_;
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

/// What HDF5 says about the last error: its innermost message.
std::string hdf5_reason();

/// Properties for opening or making a file: no locks, or in memory when `image` is wanted.
Hdf5Id hdf5_access(bool in_memory);

}  // namespace uplift
