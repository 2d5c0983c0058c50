#include "testbench/stimuli/stimuli.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace emax::test {
namespace {

void add_triangle(Stimulus& s, const Point& a, const Point& b, const Point& c) {
  const auto first = static_cast<std::uint32_t>(s.vertices.size());
  s.vertices.insert(s.vertices.end(), {a, b, c});
  s.triangles.push_back({first, first + 1, first + 2});
}

// Triangles and points anywhere: no point is near the surface.
Stimulus random_soup(Random& random, std::size_t triangles, std::size_t points) {
  Stimulus s{"random soup", {}, {}, {}};
  for (std::size_t i = 0; i < triangles; ++i) {
    const Point a = random.point(-1, 1), b = random.point(-1, 1), c = random.point(-1, 1);
    add_triangle(s, a, b, c);
  }
  for (std::size_t i = 0; i < points; ++i) s.cloud.push_back(random.point(-1.2, 1.2));
  return s;
}

// Triangles with heights around the sliver ratio, needles and obtuse triangles, where the rules of
// the frame decide.
Stimulus slivers(Random& random) {
  Stimulus s{"slivers", {}, {}, {}};
  for (int i = 0; i < 200; ++i) {
    const Point a = random.point(-1, 1), b = random.point(-1, 1);
    const double ratio = std::pow(10.0, random.uniform(-8, -2));
    const double along = random.uniform(-0.2, 1.2);
    const Point c = a + along * (b - a) + ratio * random.point(-1, 1);
    add_triangle(s, a, b, c);
  }
  for (int i = 0; i < 300; ++i) s.cloud.push_back(random.point(-1, 1));
  for (const Point& v : s.vertices) s.cloud.push_back(v + 1e-4 * random.point(-1, 1));
  return s;
}

// Triangles that are points or segments, with points on and off them.
Stimulus degenerate(Random& random) {
  Stimulus s{"degenerate", {}, {}, {}};
  for (int i = 0; i < 60; ++i) {
    const Point a = random.point(-1, 1), b = random.point(-1, 1);
    add_triangle(s, a, a, a);
    add_triangle(s, a, b, a);
    add_triangle(s, a, b, a + 0.25 * (b - a));
    s.cloud.insert(s.cloud.end(), {a, b, a + 0.5 * (b - a), random.point(-1, 1)});
  }
  return s;
}

// Every triangle and every point several times: ties everywhere, where the lowest index must win.
Stimulus duplicated(Random& random) {
  Stimulus s = random_soup(random, 10, 40);
  s.name = "duplicated";
  const auto triangles = s.triangles;
  const auto cloud = s.cloud;
  for (int copy = 0; copy < 12; ++copy) {
    s.triangles.insert(s.triangles.end(), triangles.begin(), triangles.end());
    s.cloud.insert(s.cloud.end(), cloud.begin(), cloud.end());
  }
  return s;
}

// Small integers: exact arithmetic, exact ties between different pairs.
Stimulus integer_grid(Random& random) {
  Stimulus s{"integer grid", {}, {}, {}};
  const auto corner = [&random] {
    const double x = random.below(5), y = random.below(5), z = random.below(5);
    return Point(x, y, z);
  };
  for (int i = 0; i < 60; ++i) {
    const Point a = corner(), b = corner(), c = corner();
    add_triangle(s, a, b, c);
  }
  for (int i = 0; i < 400; ++i) {
    const Point p = corner();
    s.cloud.push_back(p + Point(0, 0, random.below(4)));
  }
  return s;
}

// Every point exactly one unit from a flat mesh: one distance, many groups, the lowest index wins.
Stimulus level_ties(Random& random) {
  Stimulus s{"level ties", {}, {}, {}};
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 8; ++y) {
      add_triangle(s, Point(x, y, 0), Point(x + 1, y, 0), Point(x, y + 1, 0));
      add_triangle(s, Point(x + 1, y + 1, 0), Point(x, y + 1, 0), Point(x + 1, y, 0));
    }
  }
  for (int i = 0; i < 4000; ++i) {
    const double x = random.uniform(0, 8), y = random.uniform(0, 8);
    s.cloud.emplace_back(x, y, random.below(2) == 0 ? -1 : 1);
  }
  return s;
}

// Half of the triangles a million cloud sizes away.
Stimulus far_triangles(Random& random) {
  Stimulus s = random_soup(random, 100, 300);
  s.name = "triangles a million sizes away";
  for (std::size_t i = 0; i < s.vertices.size() / 2; ++i) s.vertices[i] += Point(1e6, -2e6, 3e5);
  return s;
}

// Huge triangles that begin at nearly the same x, seen from a flat cloud: the kernel's rounding
// there exceeds the distance between them, so bounds in exact arithmetic alone would drop a
// triangle that the kernel finds nearest.
Stimulus huge_triangles(Random& random) {
  Stimulus s{"huge triangles", {}, {}, {}};
  for (int i = 0; i < 60; ++i) {
    const double x = 0.5 + random.uniform(0, 0.02), size = random.uniform(1e5, 3e5);
    add_triangle(s, Point(x, -size, 0.01 * i), Point(x, 0.9 * size, 0.01 * i),
                 Point(5 * size, 0, 0.01 * i));
  }
  for (int i = 0; i < 400; ++i) {
    const double x = random.uniform(0, 1e-4), y = random.uniform(-1, 1), z = random.uniform(0, 0.6);
    s.cloud.emplace_back(x, y, z);
  }
  return s;
}

}  // namespace

Stimulus bumpy_sphere(std::uint32_t rings, std::uint32_t segments, std::size_t points,
                      std::uint64_t seed) {
  Random random(seed);
  Stimulus s{"bumpy sphere", {}, {}, {}};
  const auto on_surface = [](double theta, double phi) {
    const double r = 1 + 0.1 * std::sin(5 * theta) * std::cos(4 * phi);
    return Point(r * std::sin(theta) * std::cos(phi), r * std::sin(theta) * std::sin(phi),
                 r * std::cos(theta));
  };
  s.vertices.push_back(on_surface(0, 0));
  for (std::uint32_t i = 1; i < rings; ++i) {
    for (std::uint32_t j = 0; j < segments; ++j) {
      s.vertices.push_back(
          on_surface(std::numbers::pi * i / rings, 2 * std::numbers::pi * j / segments));
    }
  }
  const auto south = static_cast<std::uint32_t>(s.vertices.size());
  s.vertices.push_back(on_surface(std::numbers::pi, 0));
  for (std::uint32_t j = 0; j < segments; ++j) {
    const std::uint32_t next = (j + 1) % segments;
    s.triangles.push_back({0, 1 + j, 1 + next});
    for (std::uint32_t i = 0; i + 2 < rings; ++i) {
      const std::uint32_t upper = 1 + i * segments, lower = upper + segments;
      s.triangles.push_back({upper + j, lower + j, lower + next});
      s.triangles.push_back({upper + j, lower + next, upper + next});
    }
    const std::uint32_t last = 1 + (rings - 2) * segments;
    s.triangles.push_back({last + j, south, last + next});
  }
  for (std::size_t i = 0; i < points; ++i) {
    const double theta = std::acos(random.uniform(-1, 1));
    const double phi = random.uniform(0, 2 * std::numbers::pi);
    s.cloud.push_back(on_surface(theta, phi) + 1e-3 * random.point(-1, 1));
  }
  return s;
}

std::vector<Stimulus> all_stimuli(std::uint64_t seed) {
  Random random(seed);
  std::vector<Stimulus> all = {random_soup(random, 150, 500),
                               random_soup(random, 1, 64),
                               slivers(random),
                               degenerate(random),
                               duplicated(random),
                               integer_grid(random),
                               far_triangles(random),
                               huge_triangles(random),
                               level_ties(random),
                               bumpy_sphere(20, 30, 1500, seed)};
  all[1].name = "one triangle";
  Stimulus shifted = bumpy_sphere(16, 24, 1200, seed + 1);
  shifted.name = "far from the origin";
  for (Point& p : shifted.cloud) p += Point(1e7, -3e6, 2.5e5);
  for (Point& p : shifted.vertices) p += Point(1e7, -3e6, 2.5e5);
  all.push_back(shifted);
  return all;
}

Stimulus named_stimulus(const std::string& name, std::uint64_t seed) {
  for (Stimulus& s : all_stimuli(seed)) {
    if (s.name == name) return s;
  }
  throw std::out_of_range("no stimulus '" + name + "'");
}

}  // namespace emax::test
