#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "host/parameters/parameter.h"
#include "host/reconstruct/implicit_surface.h"
#include "host/reconstruct/local_cloud.h"

namespace emax {

// What a point's neighbours tell of it; lengths as in LocalCloud.
struct SampledPoint {
  Eigen::Vector3f position, normal;  // sharpened: it does not bend around edges
  double spacing;                    // side of the square that the point has of the surface
  double off;  // from the surface of its neighbours, beyond what an edge or a corner does
};

struct SampledCloud {
  std::vector<SampledPoint> points;     // in the order of the cloud
  std::vector<Eigen::Vector3f> fitted;  // their normals before these were sharpened
  std::vector<std::uint32_t> part;      // of each, whose normals were made consistent; from 0
};

// The first half of implicit moving least squares, which looks at neighbourhoods alone: so parts of
// a cloud give what the whole does, but for the signs of the normals. O(n k + n log n); about 700
// bytes a point.
SampledCloud sample(const LocalCloud& cloud, const ParameterValues& values, std::size_t threads);

// The spacings of at most so many points of a cloud, evenly spread over their order; without
// neighbours of other clouds. None for fewer than three points.
std::vector<double> spacings_of_some(std::span<const Point> points,
                                     const Normalization& normalization, std::size_t samples);

// What a point of the surface has a say in, once the spacing of the whole cloud is known.
class PointShape {
 public:
  // `spacing`: the median of the points' own; that of rank n / 2 from 0.
  PointShape(const ParameterValues& values, double spacing);

  float cell() const { return static_cast<float>(cell_); }
  // Nothing where the point is stray.
  std::optional<OrientedPoint> operator()(const SampledPoint& point) const;

 private:
  double spacing_, cell_, reach_, least_reach_;
};

}  // namespace emax
