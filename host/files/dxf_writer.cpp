// DXF of AutoCAD R12: pairs of lines, a group code and a value; a 3DFACE for each triangle.

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
  std::string text = fmt::format(
      "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n9\n$INSUNITS\n70\n{}\n0\nENDSEC\n"
      "0\nSECTION\n2\nENTITIES\n",
      insunits(notes.unit));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    text += "0\n3DFACE\n8\n0\n";  // on layer 0
    const std::array<Point, 3> corners = mesh.view().corners(t);
    for (int corner = 0; corner < 3; ++corner) {
      append_corner(text, corner, corners[static_cast<std::size_t>(corner)]);
    }
    append_corner(text, 3, corners[2]);  // a face whose last corners are equal is a triangle
  }
  text += "0\nENDSEC\n0\nEOF\n";
  return text;
}

}  // namespace emax
