#include "host/picture/deviation_picture.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>

#include "host/geometry/bounds.h"
#include "host/picture/png_file.h"
#include "host/picture/raster.h"
#include "host/picture/stroke_text.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

constexpr std::uint32_t kSamples = 3;  // of a pixel, along each axis
constexpr std::uint32_t kBand = 30;    // rows of pixels that are drawn at a time
constexpr Colour kPaper = {255, 255, 255}, kInk = {40, 44, 52};
constexpr Colour kMesh = {206, 210, 216}, kInside = {168, 158, 150}, kEdge = {96, 104, 116};
constexpr double kEdgeRadius = 0.4;  // pixels
// Edges appear where triangles are higher than the first number of pixels, in full from the second.
constexpr double kEdgesFrom = 3, kEdgesFull = 9;
constexpr double kEdgeStrength = 0.8;
// The discs of all points together have about so many times the area of the mesh, with a radius
// between these pixels of a picture of 600 rows.
constexpr double kCover = 1.2, kLeastRadius = 0.75, kMostRadius = 2.6;
constexpr double kNearMesh = 0.1;  // of its width: so far the points have a place in the picture

Colour mix(const Colour& a, const Colour& b, double share) {
  Colour colour;
  for (std::size_t k = 0; k < colour.size(); ++k) {
    colour[k] = static_cast<std::uint8_t>(std::lround((1 - share) * a[k] + share * b[k]));
  }
  return colour;
}

Colour dimmed(const Colour& colour, double light) { return mix({0, 0, 0}, colour, light); }

// Where things stand in the picture, in pixels.
struct Layout {
  double margin, legend_left, legend_width, legend_top, legend_bottom, text_height;
};

Layout layout_of(PictureSize size) {
  const double height = size.height, unit = height / 600;
  return {.margin = 24 * unit,
          .legend_left = size.width - 130 * unit,
          .legend_width = 18 * unit,
          .legend_top = 0.2 * height,
          .legend_bottom = 0.8 * height,
          .text_height = 11 * unit};
}

class Drawing {
 public:
  Drawing(const DeviationScene& scene, const View& view, PictureSize size)
      : scene_(scene), size_(size), layout_(layout_of(size)), camera_(view, framed(scene)) {
    const double width = layout_.legend_left - 2 * layout_.margin;
    const double height = size.height - 2 * layout_.margin;
    camera_.fit(framed(scene), kSamples * layout_.margin, kSamples * layout_.margin,
                kSamples * width, kSamples * height);
    // From above the eye's left.
    light_ = (view.back + 0.5 * view.up - 0.35 * view.up.cross(view.back)).normalized();
    radius_ = radius_of_discs();
  }

  void draw(Raster& raster) const {
    for (std::size_t t = 0; t < scene_.mesh.triangles.size(); ++t) draw_triangle(raster, t);
    for (std::size_t i = 0; i < scene_.points.size(); ++i) draw_point(raster, i);
    draw_legend(raster);
  }

 private:
  static std::vector<Point> framed(const DeviationScene& scene) {
    std::vector<Point> points;
    for (const Triangle& t : scene.mesh.triangles) {
      for (const std::uint32_t v : t) points.push_back(scene.mesh.vertices[v]);
    }
    const double near = std::max(scene.reach, kNearMesh * bounds_of(points).width());
    for (std::size_t i = 0; i < scene.points.size(); ++i) {
      if (std::abs(scene.deviations[i]) <= near) points.push_back(scene.points[i]);
    }
    return points;
  }

  // In samples. The mesh's projection is about half of the area of its triangles, seen from both
  // sides.
  double radius_of_discs() const {
    double area = 0;
    for (std::size_t t = 0; t < scene_.mesh.triangles.size(); ++t) {
      if (const auto v = seen(t)) {
        area += std::abs(((*v)[1].x - (*v)[0].x) * ((*v)[2].y - (*v)[0].y) -
                         ((*v)[2].x - (*v)[0].x) * ((*v)[1].y - (*v)[0].y)) /
                2;
      }
    }
    const auto points = static_cast<double>(std::max<std::size_t>(scene_.points.size(), 1));
    const double fitting = std::sqrt(kCover * area / points / 3.14) / kSamples;
    const double unit = size_.height / 600.0;
    return kSamples * std::clamp(fitting, kLeastRadius * unit, kMostRadius * unit);
  }

  std::optional<std::array<Seen, 3>> seen(std::size_t triangle) const {
    const std::array<Point, 3> v = scene_.mesh.corners(triangle);
    const auto a = camera_.see(v[0]), b = camera_.see(v[1]), c = camera_.see(v[2]);
    if (!a || !b || !c) return std::nullopt;
    std::array corners{*a, *b, *c};
    if (EMAX_FAULT(kPictureWithoutDepth)) {
      for (Seen& corner : corners) corner.nearness = 1;
    }
    return corners;
  }

  // How light a triangle is, and whether its outer side is seen.
  std::pair<double, bool> light_on(std::size_t triangle) const {
    const std::array<Point, 3> v = scene_.mesh.corners(triangle);
    const Point normal = (v[1] - v[0]).cross(v[2] - v[0]).stableNormalized();
    const bool outer = normal.dot(camera_.eye() - v[0]) >= 0;
    const double towards = (outer ? 1 : -1) * normal.dot(light_);
    return {0.45 + 0.55 * std::max(towards, 0.0), outer};
  }

  void draw_triangle(Raster& raster, std::size_t triangle) const {
    const auto v = seen(triangle);
    if (!v) return;
    const auto [light, outer] = light_on(triangle);
    const Colour face = dimmed(outer ? kMesh : kInside, light);
    const double height = least_height(*v) / kSamples;
    const double visible = std::clamp((height - kEdgesFrom) / (kEdgesFull - kEdgesFrom), 0.0, 1.0);
    const Colour edge = mix(face, kEdge, kEdgeStrength * visible);
    raster.fill(*v, [&](const std::array<double, 3>& from_sides) {
      return std::ranges::min(from_sides) < kEdgeRadius * kSamples ? edge : face;
    });
  }

  static double least_height(const std::array<Seen, 3>& v) {
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Seen &a = v[i], &b = v[(i + 1) % 3];
      longest = std::max(longest, std::hypot(b.x - a.x, b.y - a.y));
    }
    const double area =
        (v[1].x - v[0].x) * (v[2].y - v[0].y) - (v[2].x - v[0].x) * (v[1].y - v[0].y);
    return longest > 0 ? std::abs(area) / longest : 0;
  }

  // A point just under the surface is shown: it is drawn as if twice its distance nearer.
  void draw_point(Raster& raster, std::size_t i) const {
    auto at = camera_.see(scene_.points[i]);
    if (!at) return;
    const double deviation = scene_.deviations[i];
    at->nearness = camera_.nearer(at->nearness, 2 * std::min(std::abs(deviation), scene_.reach));
    const double light = 0.35 + 0.65 * light_on(scene_.nearest[i]).first;
    raster.disc(*at, radius_, dimmed(colour_of(deviation), light));
  }

  Colour colour_of(double deviation) const {
    return deviation_colour(deviation, scene_.reach, scene_.is_signed);
  }

  static Eigen::Vector2d pixel(double x, double y) { return {kSamples * x, kSamples * y}; }

  void draw_legend(Raster& raster) const {
    const Layout& l = layout_;
    const double from = scene_.is_signed ? -scene_.reach : 0;
    const double height = l.legend_bottom - l.legend_top;
    const auto value_at = [&](double y) {
      return from + (l.legend_bottom - y) / height * (scene_.reach - from);
    };
    draw_box(raster, l.legend_top, l.legend_bottom, [&](double y) { return value_at(y); });
    // What lies beyond has a box of its own.
    const auto beyond = [&](auto compare, double end) {
      return std::ranges::any_of(scene_.deviations, [&](double d) { return compare(d, end); });
    };
    const double gap = 0.4 * l.text_height, box = 0.9 * l.text_height;
    if (beyond(std::greater<>(), scene_.reach)) {
      draw_box(raster, l.legend_top - gap - box, l.legend_top - gap,
               [&](double) { return 2 * scene_.reach; });
    }
    if (beyond(std::less<>(), -scene_.reach)) {
      draw_box(raster, l.legend_bottom + gap, l.legend_bottom + gap + box,
               [&](double) { return -2 * scene_.reach; });
    }
    constexpr int kTicks = 4;
    for (int i = 0; i <= kTicks; ++i) {
      const double y = l.legend_bottom - height * i / kTicks;
      draw_tick(raster, y, value_at(y));
    }
    draw_text(
        raster, scene_.unit,
        pixel(l.legend_left + l.legend_width + l.text_height, l.legend_top - 2.4 * l.text_height),
        kSamples * l.text_height, kInk);
  }

  // A box of the legend, coloured by the deviation at each row.
  template <class Deviation>
  void draw_box(Raster& raster, double top, double bottom, const Deviation& deviation) const {
    const Eigen::Vector2d upper = pixel(layout_.legend_left, top);
    const Eigen::Vector2d lower = pixel(layout_.legend_left + layout_.legend_width, bottom);
    raster.for_each_in(upper.x(), lower.x(), upper.y(), lower.y(),
                       [&](double, double y, Sample& sample) {
                         sample.colour = colour_of(deviation(y / kSamples));
                       });
  }

  void draw_tick(Raster& raster, double y, double value) const {
    const double right = layout_.legend_left + layout_.legend_width;
    const double height = layout_.text_height;
    raster.line(pixel(right, y), pixel(right + 0.4 * height, y), 0.5 * kSamples, kInk);
    // Roundings of the ends are not printed.
    const double clean = std::abs(value) < 1e-9 * scene_.reach ? 0 : value;
    const std::string text =
        fmt::format("{}{:.2g}", scene_.is_signed && clean > 0 ? "+" : "", clean);
    draw_text(raster, text, pixel(right + height, y), kSamples * height, kInk);
  }

  const DeviationScene& scene_;
  PictureSize size_;
  Layout layout_;
  Camera camera_;
  Point light_;
  double radius_;  // of discs, in samples
};

// The mean of a pixel's samples.
Colour pixel_of(const Raster& raster, std::uint32_t x, std::uint32_t y) {
  std::array<unsigned, 3> sum = {};
  for (std::uint32_t j = 0; j < kSamples; ++j) {
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      const Colour& sample = raster.at(kSamples * x + i, kSamples * y + j).colour;
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += sample[k];
    }
  }
  constexpr unsigned kCount = kSamples * kSamples;
  Colour colour;
  for (std::size_t k = 0; k < sum.size(); ++k) {
    colour[k] = static_cast<std::uint8_t>((sum[k] + kCount / 2) / kCount);
  }
  return colour;
}

}  // namespace

std::string deviation_picture(const DeviationScene& scene, const View& view, PictureSize size,
                              std::size_t threads) {
  const Drawing drawing(scene, view, size);
  std::vector<Colour> pixels(std::size_t{size.width} * size.height);
  in_pieces(threads, size.height, kBand, [&](std::size_t, std::size_t first, std::size_t last) {
    const auto top = static_cast<std::uint32_t>(first), bottom = static_cast<std::uint32_t>(last);
    Raster raster(kSamples * size.width, kSamples * top, kSamples * bottom, {0, kPaper});
    drawing.draw(raster);
    for (std::uint32_t y = top; y < bottom; ++y) {
      for (std::uint32_t x = 0; x < size.width; ++x) {
        pixels[std::size_t{y} * size.width + x] = pixel_of(raster, x, y);
      }
    }
  });
  return png_bytes(pixels, size.width, size.height);
}

}  // namespace emax
