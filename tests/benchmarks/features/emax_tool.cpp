#include "host/features/find_features.h"
#include "tests/benchmarks/features/plane_tools.h"

namespace emax::benchmarks {

// Its cylinders are searched, too, and their time counts: they decide which planes stay.
std::vector<FoundPlane> planes_of_emax(const PlaneTask& task, bool hough) {
  Features features =
      find_features(task.cloud, {.planes = hough ? PlaneMethod::kHough : PlaneMethod::kGrowing,
                                 .max_error = task.band,
                                 .least_support = task.least_support,
                                 .seed = task.seed});
  std::vector<FoundPlane> found;
  for (Region& region : features.regions) {
    if (const auto* plane = std::get_if<Plane>(&region.shape)) {
      found.push_back({*plane, std::move(region.points)});
    }
  }
  return found;
}

}  // namespace emax::benchmarks
