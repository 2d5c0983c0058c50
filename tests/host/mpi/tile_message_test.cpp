#include "host/mpi/tile_message.h"

#include <gtest/gtest.h>

#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

TEST(TileMessage, CarriesATileAndItsBounds) {
  TileTask sent;
  sent.tile = {sheet(5, 0.3), 7, {}, bumpy(4, 6), 9, {{0.1, -0.0, 1e-300}}, {~0u}};
  sent.settings.epsilon = 0.1;
  sent.settings.epsilon_back = 1e-17;
  sent.settings.extent = {1e3, -2.5};
  sent.settings.two_sided = false;
  sent.settings.effort = DecimationSettings::Effort::kDeep;
  sent.settings.leaves_room = true;
  sent.settings.normal_cosine = 0.3;
  sent.settings.flatness = 1e-5;
  const TileTask got = decode_tile_task(encode(sent));
  EXPECT_TRUE(same_bytes(got.tile.mesh, sent.tile.mesh));
  EXPECT_EQ(got.tile.free, sent.tile.free);
  EXPECT_TRUE(same_bytes(got.tile.reference, sent.tile.reference));
  EXPECT_EQ(got.tile.covered, sent.tile.covered);
  EXPECT_EQ(got.tile.points, sent.tile.points);
  EXPECT_TRUE(std::signbit(got.tile.points[0][1]));
  EXPECT_EQ(got.tile.point_numbers, sent.tile.point_numbers);
  EXPECT_EQ(got.settings.epsilon, sent.settings.epsilon);
  EXPECT_EQ(got.settings.epsilon_back, sent.settings.epsilon_back);
  EXPECT_EQ(got.settings.extent.width, sent.settings.extent.width);
  EXPECT_EQ(got.settings.extent.greatest, sent.settings.extent.greatest);
  EXPECT_EQ(got.settings.two_sided, sent.settings.two_sided);
  EXPECT_EQ(got.settings.effort, sent.settings.effort);
  EXPECT_EQ(got.settings.leaves_room, sent.settings.leaves_room);
  EXPECT_EQ(got.settings.normal_cosine, sent.settings.normal_cosine);
  EXPECT_EQ(got.settings.flatness, sent.settings.flatness);
}

TEST(TileMessage, CarriesWhatATileBecame) {
  const DecimatedTile sent = {{{0.1, 2, 3}}, {{0, 1, 2}, {2, 1, 3}}, {4, 5}, true};
  const DecimatedTile got = decode_decimated_tile(encode(sent));
  EXPECT_EQ(got.added, sent.added);
  EXPECT_EQ(got.triangles, sent.triangles);
  EXPECT_EQ(got.left_out, sent.left_out);
  EXPECT_EQ(got.interrupted, sent.interrupted);
}

}  // namespace
}  // namespace emax::test
