#include "host/mpi/rank_identity.h"

#include <gtest/gtest.h>

namespace emax::test {
namespace {

RankIdentity rank(const std::string& host, const std::string& build, const std::string& probe) {
  return {host, 2, {{"build", build}, {"probe", probe}}};
}

TEST(RankIdentity, AcceptsRanksThatComputeTheSame) {
  EXPECT_FALSE(difference({rank("a", "1", "ff"), rank("b", "1", "ff")}));
}

TEST(RankIdentity, NamesTheRankOfAnotherBuild) {
  const auto why = difference({rank("a", "1", "ff"), rank("b", "1", "ff"), rank("c", "2", "ff")});
  ASSERT_TRUE(why);
  EXPECT_EQ(*why,
            "rank 2 on c would give other bytes than rank 0 on a: build 2 there, 1 here; start the "
            "same emax_mpi, with its emax_worker, on all of them");
}

TEST(RankIdentity, NamesTheRankThatComputesOtherBits) {
  const auto why = difference({rank("a", "1", "ff"), rank("b", "1", "f0")});
  ASSERT_TRUE(why);
  EXPECT_EQ(*why,
            "rank 1 on b would give other bytes than rank 0 on a: probe f0 there, ff here; take "
            "machines with the same processor and C library");
}

TEST(RankIdentity, CountsRanksOfOneHost) {
  EXPECT_EQ(most_on_one_host({rank("a", "1", ""), rank("b", "1", ""), rank("a", "1", "")}), 2u);
}

}  // namespace
}  // namespace emax::test
