#include "tests/benchmarks/bisection/cloud_error.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "sw_model/base/error.h"
#include "sw_model/base/float_bits.h"

namespace emax::benchmarks {
namespace {

// Of the cloud's half-extent: more than the kernel loses.
constexpr double kAgreement = 2e-6;

}  // namespace

CloudError::CloudError(std::span<const Point> cloud, Fault fault)
    : cloud_(fault == Fault::kNone ? cloud : cloud.first(cloud.size() / 2)), engine_(cloud_) {}

double CloudError::operator()(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return std::numeric_limits<double>::infinity();
  try {
    const PreparedMesh prepared(mesh.view(), cloud_.normalization());
    return distance_of(engine_.e_max(prepared).squared_bits) / cloud_.normalization().scale;
  } catch (const Error&) {  // coordinates that are not finite or out of reach
    return std::numeric_limits<double>::infinity();
  }
}

void CloudError::confirm(const std::string& what, double measured, double other) const {
  if (std::abs(measured - other) <= kAgreement / cloud_.normalization().scale) return;
  throw Error(
      fmt::format("{}: e_max is {} by the engine, {} by another library; find out which "
                  "is wrong",
                  what, measured, other));
}

}  // namespace emax::benchmarks
