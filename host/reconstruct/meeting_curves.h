#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/reconstruct/sheet.h"

namespace emax {

struct Interval {
  double from, to;
};

// Where two shapes meet, as far as both have points: a line of two planes, or the ellipse of a
// plane across a cylinder.
struct MeetingCurve {
  std::array<std::uint32_t, 2> sheets = {};  // their numbers, ascending
  double step = 0;                           // greatest distance of vertices that follow each other
  std::vector<Interval> parts = {};
  // The vertices of each part in their order; the first of a whole ellipse is also the last.
  std::vector<std::vector<std::uint32_t>> chains = {};

  // A line through `origin`, or an ellipse around it: the points at origin + cos(t) u + sin(t) v.
  Point origin = Point::Zero(), u = Point::Zero(), v = Point::Zero();
  bool is_line = true;  // of the unit direction `u`
  double along(const Point& p) const;
  Point at(double t) const;
  // Whether `p` lies no farther than `most` from a part.
  bool is_near(const Point& p, double most) const;
};

// The curves of all pairs of sheets, and their vertices, which are appended. Planes meet that turn
// by more than ten degrees, and cylinders that a plane turned by no less cuts; sheets whose points
// both come within their reach of the curve. A part of a line ends at the corner of three planes,
// where there is one within the lesser reach. `sagitta`: how far an edge of an ellipse may lie from
// it. O(n) for each pair of sheets of n points that may meet.
std::vector<MeetingCurve> meeting_curves(std::span<const Point> points,
                                         std::span<const Sheet> sheets, double sagitta,
                                         std::vector<Point>& vertices);

}  // namespace emax
