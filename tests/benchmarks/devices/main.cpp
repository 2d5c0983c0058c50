// emax_device_benchmark: pairs a second of every device that this machine has, and of boards by the
// model's prediction. Every pair of a made cloud and mesh is evaluated, and all results have to be
// equal. Prints a JSON list of rows; tests/benchmarks/device_bench.py makes the table.
#include <algorithm>
#include <chrono>
#include <iostream>
#include <nlohmann/json.hpp>

#include "host/block_search/block_search.h"
#include "host/block_search/simd_evaluator.h"
#include "host/device/device_address.h"
#include "host/device/opencl_device.h"
#include "sw_model/base/error.h"
#include "sw_model/simd/emax_simd.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

using nlohmann::json;

constexpr std::size_t kPoints = 16 * kMaxBlockPoints;
constexpr double kLeastSeconds = 0.5;  // of a measurement
constexpr int kRounds = 9;

struct Case {
  Case()
      : stimulus(test::bumpy_sphere(36, 36, kPoints, 83)),
        cloud(stimulus.cloud),
        mesh(stimulus.mesh(), cloud.normalization()),
        pairs(static_cast<double>(kPoints * mesh.records().size())) {}

  EmaxResult on(Evaluator& evaluator) const { return brute_force_emax(cloud, mesh, evaluator); }

  test::Stimulus stimulus;
  PreparedCloud cloud;
  TriangleTree mesh;
  double pairs;
};

void require_equal(const EmaxResult& result, const EmaxResult& expected,
                   const std::string& device) {
  if (result != expected) throw Error(device + " gives another result than the CPU");
}

// The least of several rounds, so that other work of the machine counts little; each repeats the
// case until it takes long enough.
double measured_seconds(const Case& of, Evaluator& evaluator) {
  const auto repeated = [&](int times) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < times; ++i) of.on(evaluator);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  int times = 1;
  while (repeated(times) < kLeastSeconds) times *= 2;
  double least = repeated(times) / times;
  for (int round = 1; round < kRounds; ++round) least = std::min(least, repeated(times) / times);
  return least;
}

json measured_row(const Case& of, Evaluator& evaluator, const EmaxResult& expected,
                  const std::string& device, const std::string& hardware) {
  require_equal(of.on(evaluator), expected, device);
  return {{"device", device},
          {"hardware", hardware},
          {"kind", "measured"},
          {"pairs_per_second", of.pairs / measured_seconds(of, evaluator)}};
}

// The cycles of the model at the board's clock; the link's bytes take their own time beside them.
void add_boards(json& rows, const Case& of, const EmaxResult& expected) {
  for (const BoardModel& board : board_models()) {
    const std::string device = "sim:board=" + std::string(board.name);
    const auto evaluator = make_evaluator(DeviceAddress::parse(device));
    require_equal(of.on(*evaluator), expected, device);
    const DeviceCounters counters = evaluator->counters();
    const std::uint64_t cycles = counters.cycles.value();
    rows.push_back({{"device", board.name},
                    {"hardware", board.device},
                    {"kind", "estimated"},
                    {"pairs_per_second", of.pairs / predicted_seconds(board, cycles, 0, 0)},
                    {"pairs_per_second_with_link", of.pairs / predicted_seconds(board, counters)}});
  }
}

json rows() {
  const Case of;
  SimdEvaluator cpu;
  const EmaxResult expected = emax_model(of.cloud.points(), of.mesh.records());
  json rows = json::array();
  rows.push_back(measured_row(of, cpu, expected, "cpu",
                              std::string(simd_targets().front().name()) + ", one thread"));
  std::uint32_t number = 0;
  for (const std::string& hardware : opencl_devices()) {
    const std::string device = "opencl:" + std::to_string(number++);
    const auto evaluator = make_evaluator(DeviceAddress::parse(device));
    rows.push_back(measured_row(of, *evaluator, expected, device, hardware));
  }
  add_boards(rows, of, expected);
  return {{"points", kPoints}, {"triangles", of.mesh.records().size()}, {"rows", rows}};
}

}  // namespace
}  // namespace emax

int main() {
  try {
    std::cout << emax::rows().dump(2) << "\n";
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "emax_device_benchmark: " << error.what() << "\n";
    return 1;
  }
}
