#include "tests/benchmarks/decimation/raw_mesh.h"

#include <algorithm>
#include <fstream>
#include <string>

#include "sw_model/base/error.h"

namespace emax::benchmarks {
namespace {

template <class Row>
void write_rows(const std::filesystem::path& path, const std::vector<Row>& rows) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(rows.data()),
             static_cast<std::streamsize>(rows.size() * sizeof(Row)));
  if (!file.flush()) throw Error("cannot write " + path.string());
}

template <class Row>
std::vector<Row> rows_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) throw Error("there is no file " + path.filename().string());
  const auto size = static_cast<std::size_t>(file.tellg());
  if (size % sizeof(Row) != 0) throw Error(path.filename().string() + " ends within a row");
  std::vector<Row> rows(size / sizeof(Row));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(rows.data()), static_cast<std::streamsize>(size));
  if (!file) throw Error("cannot read " + path.filename().string());
  return rows;
}

}  // namespace

void write_raw(const std::filesystem::path& folder, const TriangleMesh& mesh) {
  static_assert(sizeof(Point) == 3 * sizeof(double) && sizeof(Triangle) == 12);
  write_rows(folder / kVertexFile, mesh.vertices);
  write_rows(folder / kTriangleFile, mesh.triangles);
}

TriangleMesh read_raw(const std::filesystem::path& folder) {
  TriangleMesh mesh{rows_of<Point>(folder / kVertexFile),
                    rows_of<Triangle>(folder / kTriangleFile)};
  if (!std::ranges::all_of(mesh.vertices, [](const Point& p) { return p.allFinite(); })) {
    throw Error("a coordinate of the mesh is not finite");
  }
  for (const Triangle& triangle : mesh.triangles) {
    if (std::ranges::max(triangle) >= mesh.vertices.size()) {
      throw Error("a triangle of the mesh has a vertex that is not there");
    }
  }
  return mesh;
}

}  // namespace emax::benchmarks
