#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/decimate/close_on_planes.h"
#include "host/decimate/joining_distance.h"
#include "host/geometry/mesh_topology.h"
#include "host/geometry/scan_estimate.h"
#include "host/optimize/optimize.h"
#include "host/parameters/chain_parameters.h"
#include "host/surface/close_holes.h"
#include "host/surface/crack_free.h"

namespace emax {

// One way to make a surface of the scan, and how good it turned out.
struct TriedSurface {
  ChainSettings chain;  // with kNoDecimator
  std::string failure;  // why there is none; the rest is then 0
  std::size_t triangles = 0;
  std::size_t cracks = 0;  // count_cracks()
  std::size_t pieces = 0;  // components of less than kPieceOfArea of the area
  MeshTopology topology;
  std::size_t excess = 0;  // components, borders and handles, more than the least of all tried
  double within_half = 0;  // share of the points within half of epsilon
  double joined = 0;       // share of them that will be joined to it, one by one
  double roughness = 0;    // of a surface through the points: noise over epsilon
  std::size_t points = 0;  // of the cloud
  // What is wrong with it, about as triangles: see reference_fit.cpp.
  double cost() const;
};
inline constexpr double kPieceOfArea = 0.01;

// The method that is tried first: one through the points, or one that smooths noise away.
std::string first_method(const ScanEstimate& scan);
// The method with the values that suit the scan, of this width; with kNoDecimator.
ChainSettings fitted_chain(const std::string& method, const ScanEstimate& scan, double width);

// "no cracks, 99.8% of the points within half of the tolerance"
std::string describe(const TriedSurface& tried);

// The surface that a run holds on to, before its far points are joined.
struct ReferenceFit {
  ScanEstimate scan;
  std::size_t made_of = 0;  // points
  std::vector<TriedSurface> tried;
  std::size_t chosen = 0;  // of these
  CrackFreeSurface surface;
  // Points that were farther than joined_beyond and became vertices, and those that could not.
  JoiningDistance joined_beyond;
  std::size_t joined = 0, left_out = 0;
  // Where a closed surface was asked for: holes of the scan that were closed, and borders left.
  std::size_t closed_holes = 0;
  std::vector<OpenBorder> open;
  std::optional<ClosedOnPlanes> on_planes;  // without its mesh, where features were asked for

  const TriedSurface& best() const { return tried[chosen]; }
  // Of the parameters of its method: those whose values were fitted to the scan.
  ParameterValues fitted_values() const;
  // What made the best, as a chain that ends with the decimator.
  ChainSettings chain(const std::string& decimator) const;
};

// Reconstructs the cloud with `method`, its standard values fitted to the scan; with kFitMethod
// with the methods that may fit, and takes the surface of the least cost. Greedy projection
// interpolates the points and fits clean scans, implicit moving least squares smooth noise and span
// uneven densities. The first is taken at once where nothing is wrong with it; a surface through
// the points must also be closed for that, as its borders may be cracks too wide to be told from
// holes by themselves. Poisson's method is tried where both have faults or are far
// from many points.
//
// Of more than 1.5 times `settings.reference_points` kFitMethod takes that many, evenly spread, and
// four times as many where that leaves more points far from the surface than noise explains. The
// surface is measured by all points.
//
// Reconstruction runs in workers, the rest here. A pure function of its arguments, for any number
// of jobs. Throws Error where no surface can be made, and Interrupted.
ReferenceFit fit_reference(std::span<const Point> cloud, double epsilon,
                           const OptimizeSettings& settings);

}  // namespace emax
