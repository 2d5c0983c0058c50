#include "host/engine/engine_target.h"

#include <algorithm>
#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "host/engine/engine_target.cpp"
#include <hwy/foreach_target.h>
// These must follow foreach_target.h.
#include "host/engine/mesh_leaves-inl.h"
#include "host/engine/packet_search-inl.h"

#if HWY_ONCE

#include "sw_model/simd/simd_targets.h"

namespace emax {
namespace {

std::vector<EngineTarget> available_targets() {
  const std::int64_t supported = hwy::SupportedTargets();
  std::vector<EngineTarget> targets;
#define EMAX_TARGET(BIT, NAME, NAMESPACE)                                        \
  if ((supported & (BIT)) != 0) {                                                \
    targets.push_back({NAME, NAMESPACE::make_leaves, NAMESPACE::make_level,      \
                       NAMESPACE::search_packets, NAMESPACE::search_supergroups, \
                       NAMESPACE::nearest});                                     \
  }
  EMAX_FOR_EACH_SIMD_TARGET(EMAX_TARGET)
#undef EMAX_TARGET
  return targets;
}

}  // namespace

std::span<const EngineTarget> engine_targets() {
  static const std::vector<EngineTarget> targets = available_targets();
  return targets;
}

}  // namespace emax

#endif
