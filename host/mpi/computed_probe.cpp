#include "host/mpi/computed_probe.h"

#include <cmath>
#include <cstring>
#include <numbers>
#include <span>
#include <vector>

#include "host/parameters/descriptions.h"
#include "host/parameters/registry.h"
#include "host/worker_pool/worker_pool.h"
#include "sw_model/base/crc32.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

template <typename T>
void append(Bytes& bytes, std::span<const T> values) {
  const auto* begin = reinterpret_cast<const std::uint8_t*>(values.data());
  bytes.insert(bytes.end(), begin, begin + values.size_bytes());
}

// A sphere with bumps.
std::vector<Point> probe_cloud() {
  constexpr int kPoints = 400;
  constexpr double kGoldenAngle = std::numbers::pi * (3 - 2.2360679774997896964);
  std::vector<Point> cloud;
  for (int i = 0; i < kPoints; ++i) {
    const double z = 1 - (2 * i + 1.0) / kPoints;
    const double turn = kGoldenAngle * i;
    const double across = std::sqrt(1 - z * z), bump = 1 + 0.1 * std::sin(5 * z + 1);
    cloud.emplace_back(bump * across * std::cos(turn), bump * across * std::sin(turn), bump * z);
  }
  return cloud;
}

void append_functions(Bytes& bytes) {
  std::vector<double> values;
  for (int i = 1; i <= 2000; ++i) {
    const double x = i * (std::numbers::e / 997);
    for (const double value :
         {std::exp(x), std::log(x), std::sin(x), std::cos(x), std::tan(x), std::atan2(x, 3 - x),
          std::pow(x, 1.37), std::cbrt(x), std::acos(x / 6), std::hypot(x, 1 / x)}) {
      values.push_back(value);
    }
  }
  append(bytes, std::span<const double>(values));
}

// What each method and decimator is tried with.
std::vector<ChainSettings> probe_evaluations() {
  std::vector<ChainSettings> evaluations;
  const auto add = [&](const std::string& method, const std::string& decimator) {
    evaluations.push_back(
        {method, decimator, ParameterValues(chain_parameters(method, decimator))});
    ParameterValues& values = evaluations.back().parameters;
    if (values.contains(Hoppe::kResolution)) values.set(Hoppe::kResolution, 16);
    if (values.contains(Poisson::kDepth)) values.set(Poisson::kDepth, 4);
  };
  for (const MethodDescription& method : reconstruction_methods()) {
    add(method.name, std::string(Bounded::kName));
  }
  for (const DecimatorDescription& decimator : decimators()) {
    add(std::string(Gp3::kName), decimator.name);
  }
  return evaluations;
}

}  // namespace

std::uint32_t computed_probe() {
  Bytes bytes;
  append_functions(bytes);
  const std::vector<Point> cloud = probe_cloud();
  constexpr double kTolerance = 0.05;
  WorkerPool pool(cloud, {kTolerance, 0, {}, {}}, {});
  for (const ChainSettings& evaluation : probe_evaluations()) {
    pool.submit(0, evaluation);
    const Completed completed = pool.wait();
    if (const auto* failure = std::get_if<Failure>(&completed.outcome)) {
      throw Error("the probe of this machine's arithmetic failed: " + failure->message);
    }
    const TriangleMesh& mesh = std::get<ChainResult>(completed.outcome).mesh;
    append(bytes, std::span<const Point>(mesh.vertices));
    append(bytes, std::span<const Triangle>(mesh.triangles));
  }
  return crc32(bytes);
}

}  // namespace emax
