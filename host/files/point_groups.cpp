#include "host/files/point_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "host/files/append_value.h"
#include "host/files/input_file.h"
#include "host/files/mesh_writers.h"
#include "host/files/number_text.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

std::string ply_of_groups(const PointGroups& groups) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\n"
      "property double y\nproperty double z\nproperty uchar red\nproperty uchar green\n"
      "property uchar blue\nproperty int region\nend_header\n",
      groups.points.size());
  for (std::size_t i = 0; i < groups.points.size(); ++i) {
    const std::uint32_t group = groups.group_of[i];
    const bool none = group == PointGroups::kNone;
    for (int k = 0; k < 3; ++k) append_value(bytes, groups.points[i][k]);
    for (const std::uint8_t c : none ? kColourOfNone : groups.groups[group].colour) {
      append_value(bytes, c);
    }
    append_value(bytes, none ? std::int32_t{-1} : static_cast<std::int32_t>(group));
  }
  return bytes;
}

std::string obj_of_groups(const PointGroups& groups) {
  std::string text;
  for (const Point& p : groups.points) {
    text += "v ";
    for (int k = 0; k < 3; ++k) {
      append_shortest(text, p[k]);
      text += k < 2 ? ' ' : '\n';
    }
  }
  const auto members = members_of(groups);
  for (std::size_t g = 0; g < members.size(); ++g) {
    if (members[g].empty()) continue;
    text += fmt::format("g {}\n", g < groups.groups.size() ? groups.groups[g].name : "none");
    for (const std::uint32_t i : members[g]) {
      fmt::format_to(std::back_inserter(text), "p {}\n", std::uint64_t{i} + 1);
    }
  }
  return text;
}

}  // namespace

std::vector<std::vector<std::uint32_t>> members_of(const PointGroups& groups) {
  std::vector<std::vector<std::uint32_t>> members(groups.groups.size() + 1);
  for (std::uint32_t i = 0; i < groups.points.size(); ++i) {
    members[std::min<std::size_t>(groups.group_of[i], groups.groups.size())].push_back(i);
  }
  return members;
}

std::string group_bytes(const PointGroups& groups, const std::filesystem::path& path) {
  const std::string ending = lower_case_ending(path);
  if (ending == ".ply") return ply_of_groups(groups);
  if (ending == ".obj") return obj_of_groups(groups);
  if (ending == ".glb") return glb_of_groups(groups);
  if (ending == ".dxf") return dxf_of_groups(groups);
  throw Error(fmt::format("{}: not one of .ply .obj .glb .dxf", path.string()));
}

}  // namespace emax
