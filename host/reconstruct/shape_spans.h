#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/features/region.h"
#include "host/geometry/triangle_mesh.h"

namespace emax {

// Whether the region is of a plane, or of a cylinder a quarter of which is at least one and a half
// times as long as its points are apart.
bool can_be_spanned(const Region& region);

struct SpanOptions {
  double reach = 4;    // of the circles that points span, in multiples of their distance
  double sagitta = 0;  // how far an edge may lie from the cylinder between its ends
};

// The planes and cylinders of a scan as surfaces, after Lafarge and Alliez, "Surface reconstruction
// through point set structuring" (2013).
struct ShapeSpans {
  // First the points of the cloud, those of shapes moved onto them, then vertices of curves where
  // shapes meet and of long edges around cylinders. Triangles of a shape run the same way.
  TriangleMesh mesh;
  std::vector<std::uint32_t> owner;  // each point's region that is spanned, or kNoRegion
};

// Each shape, laid out flat, is the alpha shape of its points (alpha_shape(), Sheet). Shapes that
// meet go on to the curve where they do and share its vertices (meeting_curves()). What such curves
// cut off without a point of the shape is left out. Only regions that can be spanned are. O(n log
// n) for a shape of n points, and O(n) for each that it may meet.
ShapeSpans span_shapes(std::span<const Point> points, std::span<const Region> regions,
                       const SpanOptions& options);

}  // namespace emax
