#include "host/decimate/chain.h"

#include <algorithm>

#include "host/decimate/decimate.h"
#include "sw_model/error.h"

namespace emax {

const Reconstruction& StageCache::reconstruct(std::span<const Point> points,
                                              const ChainSettings& settings) {
  const ReconstructionMethod& method = reconstruction_method(settings.method);
  Key key{settings.method, {}};
  for (const ParameterSpec& spec : method.parameters()) {
    const auto value = settings.parameters.find(spec.name);
    if (value != settings.parameters.end()) key.second.insert(*value);
  }
  const auto known = std::find_if(recent_.begin(), recent_.end(),
                                  [&](const auto& entry) { return entry.first == key; });
  if (known != recent_.end()) {
    std::rotate(recent_.begin(), known, known + 1);
  } else {
    recent_.emplace_front(key, method.reconstruct(points, key.second));
    if (recent_.size() > capacity_) recent_.pop_back();
  }
  return recent_.front().second;
}

ChainResult run_chain(std::span<const Point> points, const ChainSettings& settings,
                      StageCache& cache) {
  for (const ParameterSpec& spec : chain_parameters(settings.method, settings.decimator)) {
    if (!settings.parameters.contains(spec.name)) {
      throw Error("the parameter " + spec.name + " has no value");
    }
  }
  const Reconstruction& reconstruction = cache.reconstruct(points, settings);
  const TriangleMesh filled = fill_holes(reconstruction.mesh, settings.parameters.at("fill.size"));
  return {decimate_schroeder(filled, settings.parameters), reconstruction.mesh.triangles.size(),
          reconstruction.unmeshed_points};
}

}  // namespace emax
