#include "sw_model/base/parallel.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "sw_model/base/error.h"

namespace emax {
namespace {

TEST(InPieces, DoesEachItemOnceOnAnyNumberOfThreads) {
  for (const std::size_t threads : {1, 2, 7}) {
    for (const std::size_t count : {0, 1, 99, 100, 1001}) {
      std::vector<int> done(count);                 // each element is of one thread
      std::vector<std::size_t> by_thread(threads);  // each element is of its thread
      in_pieces(threads, count, 10, [&](std::size_t thread, std::size_t first, std::size_t last) {
        ASSERT_LT(thread, threads);
        ASSERT_LE(last, count);
        by_thread[thread] += last - first;
        for (std::size_t i = first; i < last; ++i) ++done[i];
      });
      EXPECT_EQ(done, std::vector<int>(count, 1));
      EXPECT_EQ(std::accumulate(by_thread.begin(), by_thread.end(), std::size_t{0}), count);
    }
  }
}

TEST(InPieces, ThrowsWhatTheWorkThrew) {
  for (const std::size_t threads : {1, 4}) {
    EXPECT_THROW(in_pieces(threads, 1000, 1,
                           [](std::size_t, std::size_t first, std::size_t) {
                             if (first % 100 == 99) throw Error("a piece failed");
                           }),
                 Error);
  }
}

}  // namespace
}  // namespace emax
