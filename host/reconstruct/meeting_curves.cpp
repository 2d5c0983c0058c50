#include "host/reconstruct/meeting_curves.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

namespace emax {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kLeastMeeting = 0.17364817766693033;  // sine of ten degrees

const Plane* plane_of(const Sheet& sheet) { return std::get_if<Plane>(&sheet.shape()); }
const Cylinder* cylinder_of(const Sheet& sheet) { return std::get_if<Cylinder>(&sheet.shape()); }

Point solve(const Point& a, const Point& b, const Point& c, const Point& offsets) {
  Eigen::Matrix3d rows;
  rows << a.transpose(), b.transpose(), c.transpose();
  return rows.inverse() * offsets;
}

std::optional<MeetingCurve> line_of(const Plane& a, const Plane& b, const Point& near) {
  const Point across = a.normal.cross(b.normal);
  if (across.norm() < kLeastMeeting) return std::nullopt;
  MeetingCurve line;
  line.u = across.normalized();
  line.origin = solve(a.normal, b.normal, line.u, Point(a.offset, b.offset, line.u.dot(near)));
  return line;
}

std::optional<MeetingCurve> ellipse_of(const Plane& plane, const Cylinder& cylinder) {
  const double across = plane.normal.dot(cylinder.axis);
  if (std::abs(across) < kLeastMeeting) return std::nullopt;
  const auto cut = [&](const Point& offset) {  // where the plane cuts a line along the cylinder
    const Point p = cylinder.centre + offset;
    return Point(p - plane.signed_distance(p) / across * cylinder.axis);
  };
  MeetingCurve ellipse;
  ellipse.is_line = false;
  const Point u = cylinder.axis.unitOrthogonal();
  ellipse.origin = cut(Point::Zero());
  ellipse.u = cut(cylinder.radius * u) - ellipse.origin;
  ellipse.v = cut(cylinder.radius * cylinder.axis.cross(u)) - ellipse.origin;
  return ellipse;
}

// Sorted: where points of a sheet come within its reach of a curve.
std::vector<double> places_near(const MeetingCurve& curve, const Sheet& sheet,
                                std::span<const Point> points) {
  std::vector<double> places;
  for (const std::uint32_t i : sheet.points()) {
    const double t = curve.along(points[i]);
    if ((points[i] - curve.at(t)).norm() <= sheet.reach()) places.push_back(t);
  }
  std::ranges::sort(places);
  return places;
}

std::vector<Interval> intervals_of(std::span<const double> places, double gap) {
  std::vector<Interval> intervals;
  for (const double t : places) {
    if (!intervals.empty() && t - intervals.back().to <= gap) {
      intervals.back().to = t;
    } else {
      intervals.push_back({t, t});
    }
  }
  return intervals;
}

std::vector<Interval> common(std::span<const Interval> a, std::span<const Interval> b) {
  std::vector<Interval> both;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    const Interval part{std::max(a[i].from, b[j].from), std::min(a[i].to, b[j].to)};
    if (part.from < part.to) both.push_back(part);
    a[i].to < b[j].to ? ++i : ++j;
  }
  return both;
}

// Whether one of the sorted angles is no farther than `most` from `t`, both in [0, kTurn).
bool comes_near(std::span<const double> angles, double t, double most) {
  if (angles.empty()) return false;
  const auto at = std::ranges::lower_bound(angles, t);
  const double above = at == angles.end() ? angles.front() + kTurn : *at;
  const double below = at == angles.begin() ? angles.back() - kTurn : *std::prev(at);
  return above - t <= most || t - below <= most;
}

// The parts of an ellipse of about this radius that points of both sheets come near.
std::vector<Interval> parts_of_ellipse(const std::array<std::vector<double>, 2>& places,
                                       const std::array<double, 2>& most, std::size_t pieces) {
  const auto angle = [&](std::size_t i) {
    return kTurn * static_cast<double>(i) / static_cast<double>(pieces);
  };
  const auto is_common = [&](std::size_t i) {
    const double t = angle(i % pieces);
    return comes_near(places[0], t, most[0]) && comes_near(places[1], t, most[1]);
  };
  std::size_t start = 0;
  while (start < pieces && is_common(start)) ++start;
  if (start == pieces) return {{0, kTurn}};
  std::vector<Interval> parts;
  for (std::size_t i = start + 1; i < start + pieces; ++i) {
    if (!is_common(i)) continue;
    if (is_common(i - 1)) {
      parts.back().to = angle(i);
    } else {
      parts.push_back({angle(i), angle(i)});
    }
  }
  std::erase_if(parts, [](const Interval& part) { return !(part.from < part.to); });
  return parts;
}

class Meetings {
 public:
  Meetings(std::span<const Point> points, std::span<const Sheet> sheets, double sagitta,
           std::vector<Point>& vertices)
      : points_(points),
        sheets_(sheets),
        sagitta_(sagitta),
        vertices_(vertices),
        of_(sheets.size()) {}

  std::vector<MeetingCurve> run() {
    for (std::uint32_t a = 0; a < sheets_.size(); ++a) {
      for (std::uint32_t b = a + 1; b < sheets_.size(); ++b) meet(a, b);
    }
    for (MeetingCurve& curve : curves_) {
      if (curve.is_line) {
        place_line(curve);
      } else {
        place_ellipse(curve);
      }
    }
    return std::move(curves_);
  }

 private:
  void meet(std::uint32_t a, std::uint32_t b) {
    const Sheet &first = sheets_[a], &second = sheets_[b];
    if (first.box().exteriorDistance(second.box()) > first.reach() + second.reach()) return;
    const Plane *const plane = plane_of(first), *const other = plane_of(second);
    std::optional<MeetingCurve> curve;
    if (plane && other) {
      curve = line_of(*plane, *other, first.box().center());
    } else if (plane || other) {
      curve = plane ? ellipse_of(*plane, *cylinder_of(second))
                    : ellipse_of(*other, *cylinder_of(first));
    }
    if (!curve) return;
    curve->sheets = {a, b};
    curve->step = std::min(first.spacing(), second.spacing());
    find_parts(*curve);
    if (curve->parts.empty()) return;
    for (const std::uint32_t sheet : curve->sheets) {
      of_[sheet].push_back(static_cast<std::uint32_t>(curves_.size()));
    }
    number_of_[curve->sheets] = static_cast<std::uint32_t>(curves_.size());
    curves_.push_back(std::move(*curve));
  }

  void find_parts(MeetingCurve& curve) const {
    const Sheet &a = sheets_[curve.sheets[0]], &b = sheets_[curve.sheets[1]];
    std::array places = {places_near(curve, a, points_), places_near(curve, b, points_)};
    if (curve.is_line) {
      curve.parts =
          common(intervals_of(places[0], 2 * a.reach()), intervals_of(places[1], 2 * b.reach()));
      return;
    }
    const double radius = std::max(curve.u.norm(), curve.v.norm());
    const double flat = 2 * std::acos(std::max(0.0, 1 - sagitta_ / radius));  // turn of an edge
    const double pieces = std::ceil(kTurn / std::min(flat, curve.step / radius));
    curve.step = std::min(curve.step, kTurn / pieces * radius);
    curve.parts = parts_of_ellipse(places, {a.reach() / radius, b.reach() / radius},
                                   static_cast<std::size_t>(std::max(6.0, pieces)));
  }

  double reach_of(const MeetingCurve& line) const {
    return std::min(sheets_[line.sheets[0]].reach(), sheets_[line.sheets[1]].reach());
  }

  bool reaches(const MeetingCurve& line, const Point& p) const {
    return line.is_line && line.is_near(p, reach_of(line));
  }

  // The corners with planes that meet both of a line's planes there, by their places along it.
  std::map<double, std::uint32_t> corners_of(const MeetingCurve& line) {
    std::map<double, std::uint32_t> corners;
    const auto [a, b] = line.sheets;
    for (const std::uint32_t number : of_[a]) {
      const MeetingCurve& other = curves_[number];
      const std::uint32_t c = other.sheets[0] == a ? other.sheets[1] : other.sheets[0];
      const auto last = number_of_.find({std::min(b, c), std::max(b, c)});
      if (c == b || !other.is_line || last == number_of_.end()) continue;
      if (std::abs(plane_of(sheets_[c])->normal.dot(line.u)) < kLeastMeeting) continue;
      std::array<std::uint32_t, 3> key = {a, b, c};
      std::ranges::sort(key);
      const Point p = corner_at(key);
      if (!reaches(line, p) || !reaches(other, p) || !reaches(curves_[last->second], p)) continue;
      const auto [found, is_new] = corners_.try_emplace(key, 0u);
      if (is_new) found->second = add(p);
      corners.emplace(line.along(p), found->second);
    }
    return corners;
  }

  Point corner_at(const std::array<std::uint32_t, 3>& key) const {
    const std::array planes = {plane_of(sheets_[key[0]]), plane_of(sheets_[key[1]]),
                               plane_of(sheets_[key[2]])};
    return solve(planes[0]->normal, planes[1]->normal, planes[2]->normal,
                 Point(planes[0]->offset, planes[1]->offset, planes[2]->offset));
  }

  std::uint32_t add(const Point& p) {
    vertices_.push_back(p);
    return static_cast<std::uint32_t>(vertices_.size() - 1);
  }

  // A part ends at the corner that is nearest to its end, and has those amid it as vertices.
  void place_line(MeetingCurve& line) {
    const std::map<double, std::uint32_t> corners = corners_of(line);
    const auto snapped = [&](double end) {
      double nearest = end, least = reach_of(line);
      for (const auto& [t, vertex] : corners) {
        if (std::abs(t - end) <= least) {
          least = std::abs(t - end);
          nearest = t;
        }
      }
      return nearest;
    };
    for (Interval& part : line.parts) part = {snapped(part.from), snapped(part.to)};
    std::erase_if(line.parts, [](const Interval& part) { return !(part.from < part.to); });
    for (const Interval& part : line.parts) {
      std::map<double, std::uint32_t> fixed(corners.lower_bound(part.from),
                                            corners.upper_bound(part.to));
      for (const double end : {part.from, part.to}) {
        if (!fixed.contains(end)) fixed.emplace(end, add(line.at(end)));
      }
      std::vector<std::uint32_t>& chain = line.chains.emplace_back();
      for (auto at = fixed.begin(); std::next(at) != fixed.end(); ++at) {
        append(line, {at->first, std::next(at)->first}, line.step, at->second, chain);
      }
      chain.push_back(fixed.rbegin()->second);
    }
  }

  void place_ellipse(MeetingCurve& ellipse) {
    const double radius = std::max(ellipse.u.norm(), ellipse.v.norm());
    for (const Interval& part : ellipse.parts) {
      std::vector<std::uint32_t>& chain = ellipse.chains.emplace_back();
      append(ellipse, part, ellipse.step / radius, add(ellipse.at(part.from)), chain);
      chain.push_back(part.to - part.from < kTurn ? add(ellipse.at(part.to)) : chain.front());
    }
  }

  // The first vertex and those between it and the last, spread evenly, at most a step apart.
  void append(const MeetingCurve& curve, const Interval& part, double step, std::uint32_t first,
              std::vector<std::uint32_t>& chain) {
    chain.push_back(first);
    const int pieces =
        std::max(1, static_cast<int>(std::ceil((part.to - part.from) / step - 1e-9)));
    for (int i = 1; i < pieces; ++i) {
      chain.push_back(add(curve.at(part.from + (part.to - part.from) * i / pieces)));
    }
  }

  std::span<const Point> points_;
  std::span<const Sheet> sheets_;
  double sagitta_;
  std::vector<Point>& vertices_;
  std::vector<MeetingCurve> curves_;
  std::vector<std::vector<std::uint32_t>> of_;  // the curves of each sheet
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> number_of_;
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> corners_;
};

}  // namespace

double MeetingCurve::along(const Point& p) const {
  const Point from = p - origin;
  if (is_line) return u.dot(from);
  // Of the point of the ellipse above or below which `from` lies, seen along the cylinder: u and v
  // are conjugate.
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm();
  const double a = u.dot(from), b = v.dot(from);
  const double t = std::atan2(uu * b - uv * a, vv * a - uv * b);
  return t < 0 ? t + kTurn : t;
}

Point MeetingCurve::at(double t) const {
  return is_line ? Point(origin + t * u) : Point(origin + std::cos(t) * u + std::sin(t) * v);
}

bool MeetingCurve::is_near(const Point& p, double most) const {
  const double t = along(p);
  const auto distance_to = [&](double place, const Interval& part) {
    return (p - at(std::clamp(place, part.from, part.to))).norm();
  };
  return std::ranges::any_of(parts, [&](const Interval& part) {
    return distance_to(t, part) <= most || (!is_line && distance_to(t + kTurn, part) <= most);
  });
}

std::vector<MeetingCurve> meeting_curves(std::span<const Point> points,
                                         std::span<const Sheet> sheets, double sagitta,
                                         std::vector<Point>& vertices) {
  return Meetings(points, sheets, sagitta, vertices).run();
}

}  // namespace emax
