// PLY, OBJ, OFF and STL.

#include "host/files/mesh_writers.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <iterator>

#include "host/files/append_value.h"
#include "host/files/number_text.h"

namespace emax {
namespace {

void append_vertices(std::string& text, const TriangleMesh& mesh, std::string_view before) {
  for (const Point& v : mesh.vertices) {
    text += before;
    for (int k = 0; k < 3; ++k) {
      append_shortest(text, v[k]);
      text += k < 2 ? ' ' : '\n';
    }
  }
}

}  // namespace

std::vector<GroupRun> group_runs(const TriangleGroups& groups) {
  std::vector<GroupRun> runs;
  for (std::size_t t = 0; t < groups.group_of.size(); ++t) {
    if (runs.empty() || runs.back().group != groups.group_of[t]) {
      runs.push_back({groups.group_of[t], t, t});
    }
    runs.back().end = t + 1;
  }
  return runs;
}

std::string ply_bytes(const TriangleMesh& mesh, const MeshNotes& notes) {
  constexpr std::string_view kProperty = "property float deviation\n";
  const bool deviates = !notes.deviation.empty();
  const bool triangles_deviate = !notes.deviation_of_triangles.empty();
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\n"
      "property double y\nproperty double z\n{}element face {}\n"
      "property list uchar int vertex_indices\n{}{}end_header\n",
      mesh.vertices.size(), deviates ? kProperty : "", mesh.triangles.size(),
      triangles_deviate ? kProperty : "", notes.groups != nullptr ? "property int region\n" : "");
  bytes.reserve(bytes.size() + 24 * mesh.vertices.size() + 13 * mesh.triangles.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    for (int k = 0; k < 3; ++k) append_value(bytes, mesh.vertices[v][k]);
    if (deviates) append_value(bytes, notes.deviation[v]);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    append_value(bytes, std::uint8_t{3});
    for (const std::uint32_t corner : mesh.triangles[t]) append_value(bytes, corner);
    if (triangles_deviate) append_value(bytes, notes.deviation_of_triangles[t]);
    if (notes.groups != nullptr) {
      // kNone becomes -1.
      append_value(bytes, static_cast<std::int32_t>(notes.groups->group_of[t]));
    }
  }
  return bytes;
}

std::string obj_bytes(const TriangleMesh& mesh, const MeshNotes& notes) {
  std::string text;
  append_vertices(text, mesh, "v ");
  const auto append = [&](const Triangle& t) {
    fmt::format_to(std::back_inserter(text), "f {} {} {}\n", std::uint64_t{t[0]} + 1,
                   std::uint64_t{t[1]} + 1, std::uint64_t{t[2]} + 1);
  };
  if (notes.groups == nullptr) {
    for (const Triangle& t : mesh.triangles) append(t);
    return text;
  }
  for (const auto& [group, begin, end] : group_runs(*notes.groups)) {
    fmt::format_to(std::back_inserter(text), "g {}\n", name_of(*notes.groups, group));
    for (std::size_t t = begin; t < end; ++t) append(mesh.triangles[t]);
  }
  return text;
}

std::string off_bytes(const TriangleMesh& mesh) {
  std::string text = fmt::format("OFF\n{} {} 0\n", mesh.vertices.size(), mesh.triangles.size());
  append_vertices(text, mesh, "");
  for (const Triangle& t : mesh.triangles) {
    fmt::format_to(std::back_inserter(text), "3 {} {} {}\n", t[0], t[1], t[2]);
  }
  return text;
}

std::string stl_bytes(const TriangleMesh& mesh) {
  std::string bytes = "binary STL written by emax";
  bytes.resize(80, ' ');
  bytes.reserve(84 + 50 * mesh.triangles.size());
  append_value(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::array<Point, 3> corners = mesh.view().corners(t);
    const Point normal =
        (corners[1] - corners[0]).cross(corners[2] - corners[0]).stableNormalized();
    for (const Point& p : {normal, corners[0], corners[1], corners[2]}) {
      for (int k = 0; k < 3; ++k) append_value(bytes, static_cast<float>(p[k]));
    }
    append_value(bytes, std::uint16_t{0});
  }
  return bytes;
}

}  // namespace emax
