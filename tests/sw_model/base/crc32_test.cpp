#include "sw_model/base/crc32.h"

#include <gtest/gtest.h>

#include <string_view>
#include <vector>

namespace emax {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::uint32_t crc_of(std::string_view text) { return crc32(Bytes(text.begin(), text.end())); }

TEST(Crc32, IsTheOneOfEthernet) {
  EXPECT_EQ(crc_of(""), 0u);
  EXPECT_EQ(crc_of("123456789"), 0xcbf43926u);
  EXPECT_EQ(crc_of("a"), 0xe8b7be43u);
  EXPECT_EQ(crc32(Bytes(32, 0xff)), 0xff6cab0bu);
}

}  // namespace
}  // namespace emax
