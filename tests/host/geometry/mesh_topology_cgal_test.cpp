// Components, border loops and genus as CGAL finds them on real surfaces, whole and with triangles
// taken away at random.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>

#include "host/geometry/mesh_file.h"
#include "host/geometry/mesh_topology.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace processing = CGAL::Polygon_mesh_processing;

MeshTopology by_cgal(const TriangleMesh& mesh) {
  std::vector<Kernel::Point_3> points;
  for (const Point& p : mesh.vertices) points.emplace_back(p[0], p[1], p[2]);
  std::vector<std::vector<std::size_t>> faces;
  for (const Triangle& t : mesh.triangles) faces.push_back({t[0], t[1], t[2]});
  processing::orient_polygon_soup(points, faces);  // gives each fan a vertex of its own
  CgalMesh cgal;
  processing::polygon_soup_to_polygon_mesh(points, faces, cgal);
  for (const auto v : cgal.vertices()) {
    if (cgal.is_isolated(v)) cgal.remove_vertex(v);
  }
  MeshTopology topology;
  auto ids = cgal.add_property_map<CgalMesh::Face_index, std::size_t>("f:piece", 0).first;
  topology.components = processing::connected_components(cgal, ids);
  std::vector<CgalMesh::Halfedge_index> cycles;
  processing::extract_boundary_cycles(cgal, std::back_inserter(cycles));
  topology.border_loops = cycles.size();
  const auto characteristic = static_cast<std::ptrdiff_t>(cgal.number_of_vertices()) -
                              static_cast<std::ptrdiff_t>(cgal.number_of_edges()) +
                              static_cast<std::ptrdiff_t>(cgal.number_of_faces());
  topology.genus = static_cast<std::size_t>((2 * static_cast<std::ptrdiff_t>(topology.components) -
                                             static_cast<std::ptrdiff_t>(topology.border_loops) -
                                             characteristic) /
                                            2);
  return topology;
}

TEST(MeshTopologyCgal, ScannedSurfacesWholeAndWithHoles) {
  for (const char* file : {"bunny00.off", "fandisk.off"}) {
    const TriangleMesh whole = read_mesh(std::string(EMAX_DATA_FOLDER "/") + file);
    EXPECT_EQ(topology_of(whole.view()), by_cgal(whole)) << file;
    EXPECT_EQ(topology_of(whole.view()), (MeshTopology{1, 0, 0})) << file;
    for (const std::uint32_t one_in : {2u, 5u, 100u}) {
      SCOPED_TRACE(std::string(file) + ", one triangle taken of " + std::to_string(one_in));
      Random random(one_in);
      TriangleMesh mesh = whole;
      std::erase_if(mesh.triangles, [&](const Triangle&) { return random.below(one_in) == 0; });
      const MeshTopology topology = topology_of(mesh.view());
      EXPECT_EQ(topology, by_cgal(mesh));
      EXPECT_GT(topology.border_loops, 10u);
    }
  }
}

}  // namespace
}  // namespace emax::test
