#include <gtest/gtest.h>

#include <cstdio>
#include <utility>

#include "host/block_search/block_search.h"
#include "host/device/board_ports.h"
#include "host/device/device_evaluator.h"
#include "host/device/filtering_evaluator.h"
#include "host/device/link_device.h"
#include "host/device/queued_device.h"
#include "sw_model/protocol/timed_board.h"
#include "testbench/board/simulated_board.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

std::unique_ptr<FilteringEvaluator> filtering(std::unique_ptr<Device> board) {
  BoardPorts ports = ports_of(std::move(board));
  const std::size_t words = require_store(*ports.filter);
  return std::make_unique<FilteringEvaluator>(
      std::move(ports.filter), std::make_unique<DeviceEvaluator>(std::move(ports.exact)), words);
}

// Searches one after the other, by the board's own time: the Verilated logic at 120 MHz on a line
// of 3 Mbaud.
TEST(BoardTime, IsWhatTheSimulatedBoardTakes) {
  auto timed = std::make_unique<TimedBoard>(board_model("ulx3s"));
  const TimedBoard& predicted = *timed;
  auto channel = std::make_unique<SimulatedBoard>();
  SimulatedBoard& board = *channel;
  auto link = std::make_unique<LinkDevice>(std::move(channel));
  const LinkDevice& device = *link;
  // Queued, as the program has it: blocks that wait share frames.
  const auto model = filtering(std::move(timed));
  const auto real = filtering(std::make_unique<QueuedDevice>(
      std::move(link), QueuedDevice::kMostWords, CommandSet::kBoard));

  const test::Stimulus scan = test::bumpy_sphere(8, 12, 1500, 95);
  // A mesh with its cloud; the same again, which waits for answers and sends little; another one
  // with the cloud that is there.
  const std::pair<test::Stimulus, double> meshes[] = {
      {scan, 0.02}, {scan, 0.05}, {test::bumpy_sphere(9, 13, 10, 96), 0.05}};
  const PreparedCloud cloud(scan.cloud);
  for (const auto& [s, tolerance] : meshes) {
    const TriangleTree mesh(s.mesh(), cloud.normalization());
    const double before = *predicted.counters().predicted_seconds;
    const auto start = board.now();
    const EmaxResult answer = search_emax(cloud, mesh, *real);
    const double taken = std::chrono::duration<double>(board.now() - start).count();
    EXPECT_EQ(search_emax(cloud, mesh, *model), answer);
    const double prediction = *predicted.counters().predicted_seconds - before;
    std::printf("%zu triangles: %.4g s predicted, %.4g s taken, %.3f\n", s.triangles.size(),
                prediction, taken, prediction / taken);
    EXPECT_NEAR(prediction / taken, 1, tolerance);
  }
  EXPECT_EQ(device.link_counters().resends, 0u);
}

}  // namespace
}  // namespace emax
