#include "uplift/base/text.h"

#include <gtest/gtest.h>

namespace uplift::text_test {
namespace {

TEST(Text, BytesAreSpoken) {
  EXPECT_EQ(format_bytes(999), "999 bytes");
  EXPECT_EQ(format_bytes(1230), "1.23 kB");
  EXPECT_EQ(format_bytes(2.34e6), "2.34 MB");
  EXPECT_EQ(format_bytes(121'400'000), "121 MB");
  EXPECT_EQ(format_bytes(31.25e9), "31.25 GB");
}

}  // namespace
}  // namespace uplift::text_test
