#include "sw_model/base/public_arguments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "sw_model/base/error.h"
#include "sw_model/base/flush_mode.h"

namespace emax {
namespace {

const std::vector<double> kCorners = {0, 0, 0, 1, 0, 0, 0, 1, 0};

std::string message_of(const auto& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing";
}

TEST(PublicArguments, AreTakenInTheirOrder) {
  const std::vector<std::uint32_t> indices = {2, 0, 1};
  const OwnedSurface surface = checked_surface({kCorners, indices}, "mesh");
  EXPECT_EQ(surface.vertices[1], Point(1, 0, 0));
  EXPECT_EQ(surface.triangles[0], (Triangle{2, 0, 1}));
  const Surface again = as_public(surface.view());
  EXPECT_EQ(again.coordinates, kCorners);
  EXPECT_EQ(again.indices, indices);
}

TEST(PublicArguments, ThatAreNoneAreNamed) {
  const auto of_points = [](const std::vector<double>& coordinates) {
    return message_of([&] { checked_points(coordinates, "cloud"); });
  };
  EXPECT_EQ(of_points({}), "cloud: no points");
  EXPECT_EQ(of_points({1, 2, 3, 4}), "cloud: 4 numbers are not three a point");
  EXPECT_EQ(of_points({1, 2, 3, 4, std::nan(""), 6}), "cloud: point 1 is not finite");
  const auto of_mesh = [](const std::vector<std::uint32_t>& indices) {
    return message_of([&] { checked_surface({kCorners, indices}, "mesh"); });
  };
  EXPECT_EQ(of_mesh({}), "mesh: no triangles");
  EXPECT_EQ(of_mesh({0, 1}), "mesh: 2 indices are not three a triangle");
  EXPECT_EQ(of_mesh({0, 1, 2, 0, 1, 3}), "mesh: triangle 1 has the index 3 of 3 points");
}

TEST(PublicArguments, AreRefusedWhileSubnormalsAreFlushed) {
  EXPECT_NO_THROW(require_no_flush_of_caller());
  const ScopedFlushMode flush;
  EXPECT_THROW(require_no_flush_of_caller(), Error);
}

}  // namespace
}  // namespace emax
