#include "host/decimate/hoppe_energy.h"

#include "host/decimate/decimation_state.h"

namespace emax {

HoppeEnergy hoppe_energy(const DecimationState& state, double width, const HoppeWeights& weights) {
  const EditableMesh& mesh = state.mesh();
  const double unit = 1 / (width * width);
  HoppeEnergy energy;
  for (std::uint32_t p = 0; p < state.assigned().size(); ++p) {
    if (state.assigned().owner(p) == kNoIndex) continue;
    energy.distance += state.assigned().squared_distance(p) * unit;
  }
  std::vector<std::uint32_t> around;
  for (std::uint32_t v = 0; v < mesh.vertex_slots(); ++v) {
    if (!mesh.used(v)) continue;
    energy.representation += weights.representation;
    mesh.neighbours(v, around);
    for (const std::uint32_t n : around) {
      if (n < v) continue;
      energy.spring += weights.spring * (mesh.position(n) - mesh.position(v)).squaredNorm() * unit;
    }
  }
  return energy;
}

}  // namespace emax
