// Components, border loops and genus as CGAL finds them on real surfaces, whole and with triangles
// taken away at random.

#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <gtest/gtest.h>

#include "host/files/mesh_file.h"
#include "host/geometry/mesh_topology.h"
#include "tests/support/cgal_mesh.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

namespace processing = CGAL::Polygon_mesh_processing;

MeshTopology by_cgal(const TriangleMesh& mesh) {
  std::vector<CgalKernel::Point_3> points;
  for (const Point& p : mesh.vertices) points.push_back(cgal_point(p));
  std::vector<std::vector<std::size_t>> faces;
  for (const Triangle& t : mesh.triangles) faces.push_back({t[0], t[1], t[2]});
  processing::orient_polygon_soup(points, faces);  // gives each fan a vertex of its own
  CgalMesh cgal;
  processing::polygon_soup_to_polygon_mesh(points, faces, cgal);
  return topology_by_cgal(std::move(cgal));
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
