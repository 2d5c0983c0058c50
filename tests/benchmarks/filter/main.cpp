// What the fixed-point filter leaves open of a cloud and a mesh, for each of its widths; answers
// one JSON object. Every width has to give brute force's answer.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "host/files/cloud_file.h"
#include "host/files/mesh_file.h"
#include "sw_model/base/error.h"
#include "sw_model/model/fixed_filter.h"
#include "sw_model/model/triangle_frame.h"

namespace emax::benchmarks {
namespace {

struct Work {
  std::vector<Vector3<float>> points;
  std::vector<TriangleRecord<float>> records;
  std::vector<std::uint32_t> nearest;  // brute force's minima
};

template <int kBits>
nlohmann::ordered_json row(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  const FilteredEmax filtered = filtered_emax<kBits>(work.points, work.records);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  if (filtered.result != worst_of(work.nearest)) {
    throw Error(fmt::format("{} bits give another answer than brute force", kBits));
  }
  // In steps: how far the filter's minima are from the kernel's, and what is proven at most.
  const int exponent = filter_exponent(work.points, work.records, kBits);
  const double steps = std::ldexp(1.0, kBits - 2 + exponent);
  const FilterBounds bounds = filter_bounds<kBits>(work.points, work.records);
  double too_small = 0, too_large = 0, proven = 0;
  for (std::size_t i = 0; i < work.points.size(); ++i) {
    if (!std::isfinite(bounds.upper[i])) continue;
    const double kernel = distance_of(work.nearest[i]) * steps;
    const double f = bounds.distance[i] * steps;
    too_small = std::max(too_small, kernel - f);
    too_large = std::max(too_large, f - kernel);
    proven = std::max(proven, bounds.upper[i] * steps - f);
  }
  return {{"bits", kBits},
          {"exponent", exponent},
          {"points_left", filtered.counts.points_left},
          {"triangles_without", filtered.counts.triangles_without},
          {"greatest_too_small", too_small},
          {"greatest_too_large", too_large},
          {"greatest_bound", proven},
          {"seconds", took.count()}};
}

nlohmann::ordered_json measure(const std::filesystem::path& cloud_file,
                               const std::filesystem::path& mesh_file) {
  const std::vector<Point> cloud = read_cloud(cloud_file).points;
  const TriangleMesh mesh = read_mesh(mesh_file);
  const Normalization normalization = normalization_of(cloud);
  Work work{normalized_points(cloud, normalization), make_records(mesh.view(), normalization), {}};
  work.nearest = nearest_squared_bits(work.points, work.records);
  return {{"points", work.points.size()},
          {"triangles", work.records.size()},
          {"rows", {row<18>(work), row<16>(work), row<14>(work)}}};
}

int run(int argc, const char* const* argv) {
  CLI::App app("What the fixed-point filter leaves to the kernel");
  std::filesystem::path cloud, mesh;
  app.add_option("cloud", cloud, "whose points are measured")->required();
  app.add_option("mesh", mesh, "from what")->required();
  CLI11_PARSE(app, argc, argv);
  std::cout << measure(cloud, mesh).dump(2) << "\n";
  return 0;
}

}  // namespace
}  // namespace emax::benchmarks

int main(int argc, char** argv) {
  try {
    return emax::benchmarks::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "emax_filter_benchmark: {}\n", error.what());
    return 1;
  }
}
