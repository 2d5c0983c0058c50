#include "host/report/curve_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace emax {
namespace {

constexpr double kWidth = 640, kHeight = 420;
constexpr double kLeft = 80, kRight = 20, kTop = 20, kBottom = 60;

// Maps values to positions on a logarithmic axis. The axis begins and ends at one, two or five
// times a power of ten.
class Axis {
 public:
  Axis(double least, double greatest, double from, double to)
      : low_(step_below(least)), high_(step_above(greatest)), from_(from), to_(to) {}

  double at(double value) const {
    return from_ + (to_ - from_) * std::log(value / low_) / std::log(high_ / low_);
  }
  std::vector<double> ticks() const {
    std::vector<double> ticks;
    double tick = low_;
    while (tick <= high_ * (1 + 1e-9)) {
      ticks.push_back(tick);
      tick = next(tick);
    }
    return ticks;
  }

 private:
  static double power_below(double value) { return std::pow(10, std::floor(std::log10(value))); }
  static double step_below(double value) {
    const double power = power_below(value * (1 + 1e-12));
    return value >= 5 * power ? 5 * power : value >= 2 * power ? 2 * power : power;
  }
  static double next(double step) {
    const double leading = std::round(step / power_below(step * (1 + 1e-9)));
    return step * (leading == 2 ? 2.5 : 2);
  }
  // Above every value, so that the axis has a length.
  static double step_above(double value) { return next(step_below(value)); }

  double low_, high_, from_, to_;
};

}  // namespace

std::string curve_svg(std::vector<CurvePoint> points, const std::string& unit) {
  std::ranges::sort(points, {}, &CurvePoint::epsilon);
  const auto [fewest, most] = std::ranges::minmax(points, {}, &CurvePoint::triangles);
  const Axis x(points.front().epsilon, points.back().epsilon, kLeft, kWidth - kRight);
  const Axis y(static_cast<double>(fewest.triangles), static_cast<double>(most.triangles),
               kHeight - kBottom, kTop);

  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\" font-family=\"sans-serif\" font-size=\"13\">\n"
      "<title>Triangles by maximum error</title>\n<rect width=\"100%\" height=\"100%\" "
      "fill=\"white\"/>\n",
      kWidth, kHeight);
  for (const double tick : x.ticks()) {
    svg += fmt::format(
        "<path d=\"M{0:.1f} {1}V{2}\" stroke=\"#ddd\"/>\n<text x=\"{0:.1f}\" y=\"{3}\" "
        "text-anchor=\"middle\">{4:g}</text>\n",
        x.at(tick), kTop, kHeight - kBottom, kHeight - kBottom + 20, tick);
  }
  for (const double tick : y.ticks()) {
    svg += fmt::format(
        "<path d=\"M{1} {0:.1f}H{2}\" stroke=\"#ddd\"/>\n<text x=\"{3}\" y=\"{4:.1f}\" "
        "text-anchor=\"end\">{5:.0f}</text>\n",
        y.at(tick), kLeft, kWidth - kRight, kLeft - 8, y.at(tick) + 4, tick);
  }
  svg += fmt::format(
      "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">maximum error, {}</text>\n"
      "<text transform=\"translate(20 {}) rotate(-90)\" text-anchor=\"middle\">triangles</text>\n",
      (kLeft + kWidth - kRight) / 2, kHeight - 16, unit, (kTop + kHeight - kBottom) / 2);

  std::string line;
  for (const CurvePoint& point : points) {
    const double px = x.at(point.epsilon), py = y.at(static_cast<double>(point.triangles));
    line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", px, py);
    svg += fmt::format(
        "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"4\" fill=\"#0b57d0\"><title>{2:g}: {3} "
        "triangles</title></circle>\n",
        px, py, point.epsilon, point.triangles);
  }
  svg += fmt::format(
      "<path d=\"{}\" fill=\"none\" stroke=\"#0b57d0\" stroke-width=\"2\"/>\n</svg>\n", line);
  return svg;
}

}  // namespace emax
