// DXF of AutoCAD R12: pairs of lines, a group code and a value; a 3DFACE for each triangle, a
// POLYLINE for each outline.

#include <fmt/format.h>

#include <algorithm>

#include "host/files/dxf_units.h"
#include "host/files/mesh_writers.h"
#include "host/files/number_text.h"

namespace emax {
namespace {

int insunits(const std::optional<Unit>& unit) {
  if (!unit) return 0;
  return std::ranges::find(kDxfUnits, unit->name, [](const auto& u) { return u.second; })->first;
}

std::string header(const std::optional<Unit>& unit) {
  return fmt::format(
      "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n9\n$INSUNITS\n70\n{}\n0\nENDSEC\n"
      "0\nSECTION\n2\nENTITIES\n",
      insunits(unit));
}

constexpr std::string_view kEndOfFile = "0\nENDSEC\n0\nEOF\n";

// One of the four corners of a face: codes 10, 20, 30 and so on.
void append_corner(std::string& text, int corner, const Point& place) {
  for (int k = 0; k < 3; ++k) {
    text += fmt::format("{}\n", 10 * (k + 1) + corner);
    append_shortest(text, place[k]);
    text += '\n';
  }
}

}  // namespace

std::string dxf_bytes(const TriangleMesh& mesh, const MeshNotes& notes) {
  std::string text = header(notes.unit);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    text += "0\n3DFACE\n8\n0\n";  // on layer 0
    const std::array<Point, 3> corners = mesh.view().corners(t);
    for (int corner = 0; corner < 3; ++corner) {
      append_corner(text, corner, corners[static_cast<std::size_t>(corner)]);
    }
    append_corner(text, 3, corners[2]);  // a face whose last corners are equal is a triangle
  }
  text += kEndOfFile;
  return text;
}

std::string dxf_of_groups(const PointGroups& groups) {
  constexpr int kClosed = 1, kIn3d = 8, kVertexIn3d = 32;
  std::string text = header(groups.unit);
  for (const PointGroups::Group& group : groups.groups) {
    if (group.outline.empty()) continue;
    text += fmt::format("0\nPOLYLINE\n8\n{}\n66\n1\n70\n{}\n", group.name, kClosed | kIn3d);
    append_corner(text, 0, Point::Zero());
    for (const Point& corner : group.outline) {
      text += fmt::format("0\nVERTEX\n8\n{}\n70\n{}\n", group.name, kVertexIn3d);
      append_corner(text, 0, corner);
    }
    text += fmt::format("0\nSEQEND\n8\n{}\n", group.name);
  }
  text += kEndOfFile;
  return text;
}

}  // namespace emax
