#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/geometry/unit.h"
#include "sw_model/base/mesh_view.h"

namespace emax {

// Points in groups, each with a name, a colour and perhaps an outline.
struct PointGroups {
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  struct Group {
    std::string name;  // of letters, digits and _
    std::array<std::uint8_t, 3> colour;
    std::vector<Point> outline = {};  // closed; empty: none
  };

  std::span<const Point> points;
  std::vector<std::uint32_t> group_of;  // of each point; kNone: none
  std::vector<Group> groups;
  std::optional<Unit> unit = {};  // of the coordinates, where it is known
};

inline constexpr std::array<std::uint8_t, 3> kColourOfNone = {128, 128, 128};

inline constexpr std::array<std::string_view, 4> kGroupEndings = {".ply", ".obj", ".glb", ".dxf"};

// The bytes of a file, by its ending. PLY: the points with their colours, grey for none, and the
// number of their group as `region`, -1 for none. OBJ: a group with a point element for each point.
// GLB: a mesh of points for each group. DXF: the outlines alone, each a closed 3-D polyline on the
// layer of its name. Throws Error for another ending, and where the format has no word for the unit
// or cannot hold the points.
std::string group_bytes(const PointGroups& groups, const std::filesystem::path& path);

// The points of each group, ascending; behind them those of none.
std::vector<std::vector<std::uint32_t>> members_of(const PointGroups& groups);

}  // namespace emax
