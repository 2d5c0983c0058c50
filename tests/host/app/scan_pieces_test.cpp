#include "host/app/scan_pieces.h"

#include <gtest/gtest.h>

#include <atomic>

#include "host/files/las_stream.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"
#include "tests/support/las_of_points.h"
#include "tests/support/pipe_writer.h"
#include "tests/support/stimuli.h"
#include "tests/support/temporary_folder.h"

namespace emax {
namespace {

using test::put;

// Reads these bytes as they come. Returns the number of points.
std::uint64_t streamed(const std::string& bytes) {
  const test::TemporaryFolder folder;
  const test::PipeWriter writer(folder / "pipe", bytes);
  const ScanPieces pieces(folder / "pipe", {}, "", 0, nullptr,
                          std::make_unique<LasStream>(folder / "pipe"));
  EXPECT_FALSE(pieces.is_in_memory());
  std::atomic<std::uint64_t> points = 0;
  pieces.for_each(2, [&](const ScanPieces::Piece& piece) { points += piece.points.size(); });
  return points;
}

std::string sphere() { return test::las_of_points(test::bumpy_sphere(4, 4, 40000, 2).cloud); }

std::string with_other_box() {
  std::string bytes = sphere();
  put(bytes, 179, 7.0);
  return bytes;
}

std::string with_other_number() {
  std::string bytes = sphere();
  put(bytes, 107, std::uint32_t{39000});
  return bytes;
}

TEST(ScanStream, GivesEveryPoint) { EXPECT_EQ(streamed(sphere()), 40000u); }

TEST(ScanStream, KeepsItsPromises) {
  EXPECT_THROW(streamed(with_other_box()), Error);
  EXPECT_THROW(streamed(with_other_number()), Error);
}

TEST(ScanStream, IsNotShared) {
  const test::TemporaryFolder folder;
  for (const std::uint64_t memory : {std::uint64_t{0}, std::uint64_t{1} << 30}) {
    const test::PipeWriter writer(folder / "pipe", sphere());
    const ScanPieces pieces(folder / "pipe", {}, "", memory, nullptr,
                            std::make_unique<LasStream>(folder / "pipe"), 4);
    EXPECT_FALSE(pieces.cut());
    std::atomic<std::uint64_t> points = 0;
    pieces.for_each(2, [&](const ScanPieces::Piece& piece) { points += piece.points.size(); });
    EXPECT_EQ(points, 40000u);
  }
}

TEST(ScanStreamFault, APromiseThatIsTrustedIsNoticed) {
  const DeliberateFault fault(Fault::kTrustsPromises);
  EXPECT_EQ(streamed(with_other_box()), 40000u);
  EXPECT_EQ(streamed(with_other_number()), 39000u);
}

}  // namespace
}  // namespace emax
