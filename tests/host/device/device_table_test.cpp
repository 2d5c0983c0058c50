#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>

#include "evaluator_of.h"
#include "host/block_search/block_search.h"
#include "host/device/device_address.h"
#include "host/files/cloud_file.h"
#include "host/files/mesh_file.h"
#include "sw_model/model/emax_model.h"
#include "tests/support/board_program.h"

namespace emax {
namespace {

std::vector<Point> every(const std::vector<Point>& cloud, std::size_t step) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < cloud.size(); i += step) points.push_back(cloud[i]);
  return points;
}

// A triangle of every `step`th group of neighbouring points: near the surface, with gaps.
TriangleMesh coarse_mesh(const std::vector<Point>& cloud, std::size_t step) {
  const PreparedCloud prepared(cloud);
  TriangleMesh mesh;
  for (std::size_t g = 0; g < prepared.groups().size(); g += step) {
    const auto& points = prepared.groups()[g].points;
    if (points.size() < 3) continue;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const std::size_t i : {std::size_t{0}, points.size() / 2, points.size() - 1}) {
      mesh.vertices.push_back(cloud[points[i]]);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

struct Row {
  EmaxResult result;
  DeviceCounters counters;
};

Row run(const char* cloud_name, const std::string& device, const PreparedCloud& cloud,
        const TriangleTree& tree, bool all_pairs) {
  const auto start = std::chrono::steady_clock::now();
  const auto evaluator = test::evaluator_of(device);
  Row row;
  row.result =
      all_pairs ? brute_force_emax(cloud, tree, *evaluator) : search_emax(cloud, tree, *evaluator);
  row.counters = evaluator->counters();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const auto share = [&](std::optional<std::uint64_t> part) {
    return part && row.counters.cycles
               ? 100 * static_cast<double>(*part) / static_cast<double>(*row.counters.cycles)
               : std::nan("");
  };
  std::printf("%-22s %-14s %08x %7u %5llu %10llu %10llu %8llu %11llu %6.1f %6.1f\n", cloud_name,
              device.substr(0, device.find('/')).c_str(), row.result.squared_bits,
              row.result.worst_point, static_cast<unsigned long long>(row.counters.blocks),
              static_cast<unsigned long long>(row.counters.pairs),
              static_cast<unsigned long long>(row.counters.words_in),
              static_cast<unsigned long long>(row.counters.words_out),
              static_cast<unsigned long long>(row.counters.cycles.value_or(0)),
              share(row.counters.busy), seconds.count());
  std::fflush(stdout);
  return row;
}

// With the filter: the answer of `exact` from the same blocks, with fewer pairs of the kernel's,
// and the same counts in C++ and in hardware.
void expect_filter_agrees(const char* name, const PreparedCloud& cloud, const TriangleTree& tree,
                          const Row& exact) {
  const Row sim = run(name, "sim:filter", cloud, tree, false);
  const Row rtl = run(name, "rtl:filter", cloud, tree, false);
  for (const Row& row : {sim, rtl}) {
    EXPECT_EQ(row.result, exact.result);
    EXPECT_EQ(row.counters.blocks, exact.counters.blocks);
    EXPECT_LT(row.counters.pairs, exact.counters.pairs);
  }
  EXPECT_EQ(rtl.counters.pairs, sim.counters.pairs);
  EXPECT_EQ(rtl.counters.filtered_pairs, sim.counters.filtered_pairs);
  EXPECT_EQ(rtl.counters.points_left, sim.counters.points_left);
  EXPECT_EQ(rtl.counters.words_in, sim.counters.words_in);
  EXPECT_EQ(rtl.counters.words_out, sim.counters.words_out);
  EXPECT_EQ(rtl.counters.busy, sim.counters.busy);
  const auto counted = static_cast<double>(*rtl.counters.busy + *rtl.counters.stalled);
  EXPECT_NEAR(static_cast<double>(*sim.counters.cycles) / counted, 1.0, 0.02);
  std::printf("  %llu pairs in the filter, %llu of %llu points left\n",
              static_cast<unsigned long long>(*sim.counters.filtered_pairs),
              static_cast<unsigned long long>(*sim.counters.points_left),
              static_cast<unsigned long long>(*sim.counters.filtered_points));
}

// All pairs of a sample, through the Verilated filter.
EmaxResult filtered_sample(const std::vector<Point>& points, const TriangleMesh& mesh) {
  const PreparedCloud cloud(points);
  const TriangleTree tree(mesh.view(), cloud.normalization());
  return run("  sample, all pairs", "rtl:filter", cloud, tree, true).result;
}

// One cloud, every device: equal bits, worst points and counts. `serial_step` thins the cloud for
// the simulated board, whose serial line takes eighty cycles a word.
void expect_devices_agree(const char* name, const std::vector<Point>& scan, std::size_t mesh_step,
                          const std::string& board, std::size_t serial_step) {
  const TriangleMesh mesh = coarse_mesh(scan, mesh_step);
  {
    const PreparedCloud cloud(scan);
    const TriangleTree tree(mesh.view(), cloud.normalization());
    const EmaxResult cpu = run(name, "cpu", cloud, tree, false).result;
    const Row sim = run(name, "sim", cloud, tree, false);
    EXPECT_EQ(sim.result, cpu);
    for (const char* device : {"rtl", "rtl:pes=2", "rtl:pes=4", "opencl"}) {
      const Row rtl = run(name, device, cloud, tree, false);
      EXPECT_EQ(rtl.result, cpu) << device;
      EXPECT_EQ(rtl.counters.blocks, sim.counters.blocks) << device;
      EXPECT_EQ(rtl.counters.pairs, sim.counters.pairs) << device;
      EXPECT_EQ(rtl.counters.words_in, sim.counters.words_in) << device;
      EXPECT_EQ(rtl.counters.words_out, sim.counters.words_out) << device;
      if (std::string(device) != "rtl") continue;
      // The cycle model against the core's own counters.
      const auto predicted = static_cast<double>(*sim.counters.cycles);
      const auto counted = static_cast<double>(*rtl.counters.busy + *rtl.counters.stalled);
      EXPECT_NEAR(predicted / counted, 1.0, 0.02);
      EXPECT_EQ(sim.counters.busy, rtl.counters.busy);
    }
    expect_filter_agrees(name, cloud, tree, sim);
  }
  // `twin` is the C++ of these devices.
  const auto thin = [&](const char* what, std::size_t step, const char* twin,
                        const std::vector<std::string>& devices, bool all_pairs) {
    const PreparedCloud cloud(every(scan, step));
    const TriangleTree tree(mesh.view(), cloud.normalization());
    const Row expected = run(what, "cpu", cloud, tree, all_pairs);
    const Row sim = run(what, twin, cloud, tree, all_pairs);
    EXPECT_EQ(sim.result, expected.result);
    for (const std::string& device : devices) {
      const Row row = run(what, device, cloud, tree, all_pairs);
      EXPECT_EQ(row.result, expected.result) << device;
      EXPECT_EQ(row.counters.blocks, sim.counters.blocks) << device;
      EXPECT_EQ(row.counters.pairs, sim.counters.pairs) << device;
      EXPECT_EQ(row.counters.words_in, sim.counters.words_in) << device;
      EXPECT_EQ(row.counters.words_out, sim.counters.words_out) << device;
    }
    return expected.result;
  };
  const char* const board_twin = "sim:board=ulx3s";
  thin("  thinned", serial_step, board_twin, {"tty:" + board}, false);
  // Every pair of a sample: what the search must give.
  const std::size_t sample = scan.size() / 100;
  const EmaxResult all =
      thin("  sample, all pairs", sample, "sim", {"rtl", "rtl:pes=4", "opencl"}, true);
  const EmaxResult filtered = filtered_sample(every(scan, sample), mesh);
  EXPECT_EQ(all, thin("  sample", sample, "sim", {"rtl"}, false));
  EXPECT_EQ(all, thin("  sample", sample, board_twin, {"tty:" + board}, false));
  EXPECT_EQ(all, filtered);
  // Every point's own bits.
  const PreparedCloud cloud(every(scan, sample));
  const TriangleTree tree(mesh.view(), cloud.normalization());
  const auto expected = nearest_squared_bits(cloud.points(), tree.records());
  for (const std::string& device :
       {std::string("cpu"), std::string("sim"), std::string("rtl:pes=2"), std::string("opencl"),
        "tty:" + board}) {
    const auto evaluator = test::evaluator_of(device);
    EXPECT_EQ(search_nearest(cloud, tree, *evaluator), expected) << device;
  }
}

TEST(Devices, AgreeOnRealScans) {
  test::BoardProgram board(EMAX_BOARD_PROGRAM);
  std::printf("%-22s %-14s %8s %7s %5s %10s %10s %8s %11s %6s %6s\n", "cloud", "device", "e_max^2",
              "worst", "block", "pairs", "words in", "out", "cycles", "busy %", "s");
  const std::vector<Point> bunny = read_mesh(EMAX_DATA_FOLDER "/bunny00.off").vertices;
  expect_devices_agree("bunny00", bunny, 4, board.path(), 2);
  const std::vector<Point> building = read_cloud(EMAX_DATA_FOLDER "/building.ply").points;
  expect_devices_agree("building", building, 12, board.path(), 8);
}

}  // namespace
}  // namespace emax
