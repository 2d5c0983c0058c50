#pragma once

#include <optional>
#include <span>

#include "sw_model/base/mesh_view.h"

namespace emax {

// From where a scene is looked at. Unit vectors.
struct View {
  Point up = Point::UnitZ();
  Point back = -Point::UnitY();  // from the scene to the eye
};

// The axis that is up: z, unless the points stand on y: where the lowest points along y spread
// over more than twice the part of the bounding box over which those along z spread. O(n).
Point up_of(std::span<const Point> points);

// A view of the mesh from a little above, round the axis that is up, that shows most of its outer
// side: the area of the projection, in which triangles seen from behind count less, of 24
// directions. Between equal ones the front counts: from -y if z is up, from +z if y is up. The
// same for any processor. O(triangles), of which at most 300,000 are looked at.
View view_of(MeshView mesh, std::span<const Point> points);

// A point as the camera sees it: pixels from the upper left corner, y downward, and the inverse of
// the distance from the eye along the axis of view, which is linear over the picture of a plane.
struct Seen {
  double x, y, nearness;
};

// A camera in perspective. The eye is so far away that lines along the axis of view hardly meet.
class Camera {
 public:
  // `at`: the points to look at, at least one; the eye is outside of the ball around them.
  Camera(const View& view, std::span<const Point> at);

  // The points of `at` then fill the rectangle as far as they can, in its middle.
  void fit(std::span<const Point> at, double x, double y, double width, double height);
  // The ball fills a square of that many pixels.
  void fit_ball(double pixels);

  // Nothing for a point beside or behind the eye.
  std::optional<Seen> see(const Point& p) const;
  // How near a point is seen that lies `length` nearer to the eye.
  double nearer(double nearness, double length) const;
  Point eye() const { return middle_ + distance_ * back_; }

 private:
  struct Ray {
    double u, v, depth;
  };
  Ray ray(const Point& p) const;

  Point right_, up_, back_, middle_;
  double radius_, distance_;
  double scale_ = 1, shift_x_ = 0, shift_y_ = 0;
};

}  // namespace emax
