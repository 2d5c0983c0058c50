#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "host/decimate/chain_parameters.h"
#include "host/decimate/crack_free.h"
#include "host/optimize/optimize.h"
#include "host/reconstruct/scan_estimate.h"

namespace emax {

// One way to make a surface of the scan, and how good it turned out.
struct TriedSurface {
  ChainSettings chain;  // with kNoDecimator
  std::string failure;  // why there is none; the rest is then 0
  std::size_t triangles = 0;
  std::size_t cracks = 0;          // count_cracks()
  std::size_t borders = 0;         // border loops, cracks included
  std::size_t excess_borders = 0;  // more than the least of all that were tried
  std::size_t pieces = 0;          // components of less than kPieceOfArea of the area
  double within_half = 0;          // share of the points within half of epsilon
  double unexplained = 0;          // share of them farther than that and than noise explains
  double roughness = 0;            // of a noisy surface through the points: noise over spacing
  std::size_t points = 0;          // of the cloud
  // What is wrong with it, in points: a crack, a piece or a border that another surface has not
  // counts 100, a point that is farther off than noise explains 0.1, and a point whose noise the
  // surface has 0.5 times its share of the spacing.
  double cost() const;
};
inline constexpr double kPieceOfArea = 0.01;

// "no cracks, 99.8% of the points within half of the tolerance"
std::string describe(const TriedSurface& tried);

// The surface that a run holds on to, before its far points are joined.
struct ReferenceFit {
  ScanEstimate scan;
  std::vector<TriedSurface> tried;
  std::size_t chosen = 0;  // of these
  CrackFreeSurface surface;
  // Points that were farther than joined_beyond and became vertices, and those that could not.
  double joined_beyond = 0;
  std::size_t joined = 0, left_out = 0;

  const TriedSurface& best() const { return tried[chosen]; }
};

// Reconstructs the cloud with `method`, its standard values fitted to the scan; with kFitMethod
// with the methods that may fit, and takes the surface of the least cost. Greedy projection
// interpolates the points and fits clean scans, implicit moving least squares smooth noise and span
// uneven densities. The first is taken at once where nothing is wrong with it; a surface through
// the points must also be closed for that, as its borders may be cracks too wide to be told from
// holes by themselves.
//
// Reconstruction runs in workers, the rest here. A pure function of its arguments, for any number
// of jobs. Throws Error where no surface can be made, and Interrupted.
ReferenceFit fit_reference(std::span<const Point> cloud, double epsilon,
                           const OptimizeSettings& settings);

}  // namespace emax
