#include "host/chain/stage_cache.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace emax {
namespace {

struct Text {
  std::string text;
  std::size_t size_in_bytes() const { return text.size(); }
};

class StageCacheTest : public testing::Test {
 protected:
  const std::string& get(int key, std::size_t bytes = 4) {
    return cache_
        .get(key,
             [&] {
               ++calls_;
               return Text{std::string(bytes, static_cast<char>('a' + key))};
             })
        .text;
  }

  StageCache<int, Text> cache_{10};
  int calls_ = 0;
};

TEST_F(StageCacheTest, MakesAValueOnce) {
  EXPECT_EQ(get(0), "aaaa");
  EXPECT_EQ(get(0), "aaaa");
  EXPECT_EQ(calls_, 1);
  EXPECT_EQ(cache_.made(), 1u);
  EXPECT_EQ(cache_.bytes(), 4u);
}

TEST_F(StageCacheTest, DropsTheValueThatWasAskedForLongestAgo) {
  get(0);
  get(1);
  get(0);  // 1 is older now
  get(2);
  EXPECT_EQ(cache_.size(), 2u);
  EXPECT_EQ(cache_.bytes(), 8u);
  get(0);
  EXPECT_EQ(calls_, 3);
  get(1);
  EXPECT_EQ(calls_, 4);
}

TEST_F(StageCacheTest, KeepsTheLastWhateverItsSize) {
  get(0);
  get(1, 100);
  EXPECT_EQ(cache_.size(), 1u);
  EXPECT_EQ(get(1), std::string(100, 'b'));
  EXPECT_EQ(calls_, 2);
  get(0);
  EXPECT_EQ(cache_.bytes(), 4u);
}

TEST_F(StageCacheTest, KeepsNothingOfAFailure) {
  EXPECT_THROW(cache_.get(7, []() -> Text { throw std::runtime_error("no"); }), std::runtime_error);
  EXPECT_EQ(cache_.size(), 0u);
  EXPECT_EQ(get(7), "hhhh");
}

}  // namespace
}  // namespace emax
