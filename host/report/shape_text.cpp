#include "host/report/shape_text.h"

#include <fmt/format.h>

namespace emax {
namespace {

Json coordinates(const Point& p) { return Json{p.x(), p.y(), p.z()}; }

std::string triple(const Point& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
}

struct KindOf {
  const char* operator()(const Plane&) const { return "plane"; }
  const char* operator()(const Cylinder&) const { return "cylinder"; }
  const char* operator()(const Sphere&) const { return "sphere"; }
};

struct EquationOf {
  std::string operator()(const Plane& p) const {
    return fmt::format("normal ({:.5f}, {:.5f}, {:.5f}), offset {:.6g}", p.normal.x(), p.normal.y(),
                       p.normal.z(), p.offset);
  }
  std::string operator()(const Cylinder& c) const {
    return fmt::format("radius {:.5g}, axis ({:.5f}, {:.5f}, {:.5f}) through {}", c.radius,
                       c.axis.x(), c.axis.y(), c.axis.z(), triple(c.centre));
  }
  std::string operator()(const Sphere& s) const {
    return fmt::format("radius {:.5g}, centre {}", s.radius, triple(s.centre));
  }
};

struct ShapeJson {
  Json operator()(const Plane& p) const {
    return {{"normal", coordinates(p.normal)}, {"offset", p.offset}};
  }
  Json operator()(const Cylinder& c) const {
    return {{"radius", c.radius}, {"axis", coordinates(c.axis)}, {"centre", coordinates(c.centre)}};
  }
  Json operator()(const Sphere& s) const {
    return {{"radius", s.radius}, {"centre", coordinates(s.centre)}};
  }
};

}  // namespace

std::string kind_of(const Shape& shape) { return std::visit(KindOf{}, shape); }
std::string equation_text(const Shape& shape) { return std::visit(EquationOf{}, shape); }
Json equation_json(const Shape& shape) { return std::visit(ShapeJson{}, shape); }

}  // namespace emax
