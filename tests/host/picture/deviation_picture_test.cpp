#include "host/picture/deviation_picture.h"

#include <gtest/gtest.h>
#include <png.h>

#include "host/geometry/triangle_mesh.h"
#include "host/picture/colour.h"
#include "sw_model/base/deliberate_fault.h"

namespace emax {
namespace {

constexpr PictureSize kSize{400, 300};

// What libpng reads.
struct Picture {
  std::uint32_t width = 0, height = 0;
  std::vector<Colour> pixels;
  const Colour& at(double x, double y) const {  // shares of width and height
    return pixels[static_cast<std::size_t>(y * height) * width +
                  static_cast<std::size_t>(x * width)];
  }
};

Picture read(const std::string& bytes) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
  image.format = PNG_FORMAT_RGB;
  Picture picture{image.width, image.height, {}};
  picture.pixels.resize(std::size_t{image.width} * image.height);
  EXPECT_NE(png_image_finish_read(&image, nullptr, picture.pixels.data(), 0, nullptr), 0);
  return picture;
}

// Seen from -y: a wall whose points lie outside on the left, inside on the right.
struct Wall {
  TriangleMesh mesh{{{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}}, {{0, 1, 2}, {0, 2, 3}}};
  DeviationScene scene() {
    DeviationScene scene;
    scene.mesh = mesh.view();
    scene.is_signed = true;
    scene.reach = 0.01;
    scene.unit = "mm";
    for (double x = -0.95; x < 1; x += 0.02) {
      for (double z = -0.95; z < 1; z += 0.02) {
        const double deviation = x < 0 ? 0.009 : -0.009;
        scene.points.push_back({x, -deviation, z});
        scene.deviations.push_back(deviation);
        scene.nearest.push_back(x < z ? 1 : 0);
      }
    }
    return scene;
  }
};

TEST(DeviationPicture, ShowsTheSidesInTheirColours) {
  Wall wall;
  const DeviationScene scene = wall.scene();
  const Picture picture = read(deviation_picture(scene, View{}, kSize, 1));
  ASSERT_EQ(picture.width, kSize.width);
  ASSERT_EQ(picture.height, kSize.height);
  EXPECT_EQ(picture.at(0.01, 0.01), (Colour{255, 255, 255}));
  std::size_t red = 0, blue = 0, wrong = 0;
  for (std::uint32_t y = 60; y < 240; ++y) {
    for (std::uint32_t x = 40; x < 300; ++x) {
      const Colour& c = picture.pixels[std::size_t{y} * picture.width + x];
      if (c[0] > c[2] + 60) ++(x < 171 ? red : wrong);
      if (c[2] > c[0] + 60) ++(x > 164 ? blue : wrong);
    }
  }
  EXPECT_GT(red, 5000u);
  EXPECT_GT(blue, 5000u);
  EXPECT_EQ(wrong, 0u);
}

TEST(DeviationPicture, HasALegendWithNumbers) {
  Wall wall;
  const DeviationScene scene = wall.scene();
  const Picture picture = read(deviation_picture(scene, View{}, kSize, 1));
  const double bar = (400 - 130 * 0.5 + 9 * 0.5) / 400;
  const Colour top = picture.at(bar, 0.21), bottom = picture.at(bar, 0.79);
  EXPECT_GT(top[0], top[2] + 60);
  EXPECT_GT(bottom[2], bottom[0] + 60);
  std::size_t ink = 0;  // right of the bar
  for (std::uint32_t y = 0; y < 300; ++y) {
    for (std::uint32_t x = 350; x < 400; ++x) {
      ink += picture.pixels[std::size_t{y} * 400 + x][0] < 128 ? 1 : 0;
    }
  }
  EXPECT_GT(ink, 40u);
}

TEST(DeviationPicture, HasTheSameBytesForAnyNumberOfThreads) {
  Wall wall;
  const DeviationScene scene = wall.scene();
  const std::string one = deviation_picture(scene, View{}, kSize, 1);
  for (const std::size_t threads : {2u, 7u}) {
    EXPECT_EQ(deviation_picture(scene, View{}, kSize, threads), one);
  }
}

TEST(DeviationPicture, FarPointsDoNotMakeTheMeshSmall) {
  Wall wall;
  DeviationScene scene = wall.scene();
  const Picture before = read(deviation_picture(scene, View{}, kSize, 1));
  scene.points.push_back({500, 0, 500});
  scene.points.push_back({0, -1e9, 0});  // behind the eye
  for (int i = 0; i < 2; ++i) {
    scene.deviations.push_back(500);
    scene.nearest.push_back(0);
  }
  const Picture after = read(deviation_picture(scene, View{}, kSize, 1));
  EXPECT_EQ(before.at(0.3, 0.5), after.at(0.3, 0.5));
  EXPECT_EQ(before.at(0.6, 0.5), after.at(0.6, 0.5));
}

// A far wall that is seen from outside, and before it a near one that is seen from inside, which is
// drawn in another colour.
Colour middle_of_two_walls() {
  TriangleMesh mesh;
  for (const double y : {0.0, -0.5}) {
    for (const auto& [x, z] : {std::pair(-1.0, -1.0), {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
      mesh.vertices.push_back({x, y, z});
    }
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}};
  DeviationScene scene;
  scene.mesh = mesh.view();
  return read(deviation_picture(scene, View{}, kSize, 1)).at(0.45, 0.4);
}

bool is_inside(const Colour& c) { return c[0] > c[2]; }  // brownish; the outer side is bluish

TEST(DeviationPicture, TheNearWallHidesTheFarOne) { EXPECT_TRUE(is_inside(middle_of_two_walls())); }

TEST(DeviationPictureFault, MissingDepthIsCaught) {
  const DeliberateFault fault(Fault::kPictureWithoutDepth);
  EXPECT_FALSE(is_inside(middle_of_two_walls()));
}

}  // namespace
}  // namespace emax
