#include "uplift/io/hdf5/hdf5.h"

#include <gtest/gtest.h>

#include <array>
#include <future>
#include <numeric>
#include <vector>

namespace uplift::hdf5_test {
namespace {

/// Writes a file in memory and reads it back: whether all numbers are the same.
bool comes_back(int seed) {
  std::vector<double> values(997);
  std::iota(values.begin(), values.end(), seed);
  const std::array<std::int64_t, 1> shape{static_cast<std::int64_t>(values.size())};
  Hdf5Writer writer = Hdf5Writer::in_memory();
  writer.numbers("/a/numbers", values, shape);
  writer.attribute("/a", "seed", seed);
  const Hdf5Reader reader = Hdf5Reader::from_memory(writer.image(), "memory of " + std::to_string(seed));
  return reader.numbers("/a/numbers") == values && reader.integer_attribute("/a", "seed") == seed && !reader.has("/b");
}

// Different handles of the library may be used by different threads; the HDF5 of Debian may not.
TEST(Hdf5, SeveralThreadsUseSeveralFiles) {
  std::vector<std::future<int>> threads;
  for (int t = 0; t < 4; ++t)
    threads.push_back(std::async(std::launch::async, [t] {
      int good = 0;
      for (int k = 0; k < 200; ++k) good += comes_back(1000 * t + k) ? 1 : 0;
      return good;
    }));
  for (std::future<int>& thread : threads) EXPECT_EQ(thread.get(), 200);
}

}  // namespace
}  // namespace uplift::hdf5_test
