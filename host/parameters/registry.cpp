#include "host/parameters/registry.h"

namespace emax {

Parameters Mls::parameters() {
  Parameters all = parameters_of(kMethod, kRadius, kOrder, kCell);
  const Gene::Condition used = {0, static_cast<double>(Method::kNone), true};
  const Gene::Condition resampled = {0, static_cast<double>(Method::kResample)};
  all[1].only_with = all[2].only_with = used;
  all[3].only_with = resampled;
  return all;
}

Parameters Fill::parameters() {
  Parameters all = parameters_of(kMethod, kSize);
  all[1].only_with = {0, static_cast<double>(Method::kNone), true};
  return all;
}

Parameters PlaneFeatures::parameters() {
  Parameters all = parameters_of(kMethod, kBand, kLeastPoints, kSpread);
  const Gene::Condition followed = {0, static_cast<double>(Method::kNone), true};
  all[1].only_with = all[2].only_with = all[3].only_with = followed;
  return all;
}

}  // namespace emax
