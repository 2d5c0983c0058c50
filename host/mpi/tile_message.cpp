#include "host/mpi/tile_message.h"

#include <nlohmann/json.hpp>

#include "host/worker_pool/packed.h"

namespace emax {
namespace {

using nlohmann::json;

json parsed(std::span<const std::uint8_t> bytes) {
  return json::from_cbor(bytes.begin(), bytes.end());
}

}  // namespace

Bytes encode(const TileTask& task) {
  const Tile& tile = task.tile;
  const DecimationSettings& s = task.settings;
  return json::to_cbor({{"vertices", packed(tile.mesh.vertices)},
                        {"triangles", packed(tile.mesh.triangles)},
                        {"free", tile.free},
                        {"reference_vertices", packed(tile.reference.vertices)},
                        {"reference_triangles", packed(tile.reference.triangles)},
                        {"covered", tile.covered},
                        {"points", packed(tile.points)},
                        {"point_numbers", packed(tile.point_numbers)},
                        {"epsilon", s.epsilon},
                        {"width", s.extent.width},
                        {"greatest", s.extent.greatest},
                        {"two_sided", s.two_sided},
                        {"epsilon_back", s.epsilon_back},
                        {"effort", static_cast<int>(s.effort)},
                        {"leaves_room", s.leaves_room},
                        {"normal_cosine", s.normal_cosine},
                        {"flatness", s.flatness}});
}

TileTask decode_tile_task(std::span<const std::uint8_t> bytes) {
  const json j = parsed(bytes);
  TileTask task;
  task.tile.mesh.vertices = unpacked<Point>(j.at("vertices"));
  task.tile.mesh.triangles = unpacked<Triangle>(j.at("triangles"));
  j.at("free").get_to(task.tile.free);
  task.tile.reference.vertices = unpacked<Point>(j.at("reference_vertices"));
  task.tile.reference.triangles = unpacked<Triangle>(j.at("reference_triangles"));
  j.at("covered").get_to(task.tile.covered);
  task.tile.points = unpacked<Point>(j.at("points"));
  task.tile.point_numbers = unpacked<std::uint32_t>(j.at("point_numbers"));
  DecimationSettings& s = task.settings;
  j.at("epsilon").get_to(s.epsilon);
  j.at("width").get_to(s.extent.width);
  j.at("greatest").get_to(s.extent.greatest);
  j.at("two_sided").get_to(s.two_sided);
  j.at("epsilon_back").get_to(s.epsilon_back);
  s.effort = static_cast<DecimationSettings::Effort>(j.at("effort").get<int>());
  j.at("leaves_room").get_to(s.leaves_room);
  j.at("normal_cosine").get_to(s.normal_cosine);
  j.at("flatness").get_to(s.flatness);
  return task;
}

Bytes encode(const DecimatedTile& result) {
  return json::to_cbor({{"added", packed(result.added)},
                        {"triangles", packed(result.triangles)},
                        {"left_out", packed(result.left_out)},
                        {"interrupted", result.interrupted}});
}

DecimatedTile decode_decimated_tile(std::span<const std::uint8_t> bytes) {
  const json j = parsed(bytes);
  DecimatedTile result;
  result.added = unpacked<Point>(j.at("added"));
  result.triangles = unpacked<Triangle>(j.at("triangles"));
  result.left_out = unpacked<std::uint32_t>(j.at("left_out"));
  j.at("interrupted").get_to(result.interrupted);
  return result;
}

}  // namespace emax
