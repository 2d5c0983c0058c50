#include <OpenMesh/Core/System/config.h>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModHausdorffT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <memory>

#include "tests/benchmarks/decimation/tool.h"

namespace emax::benchmarks {
namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;
using Decimater = OpenMesh::Decimater::DecimaterT<Mesh>;
using Quadric = OpenMesh::Decimater::ModQuadricT<Mesh>;
using Hausdorff = OpenMesh::Decimater::ModHausdorffT<Mesh>;
using Flipping = OpenMesh::Decimater::ModNormalFlippingT<Mesh>;

Mesh to_openmesh(const TriangleMesh& mesh) {
  Mesh result;
  for (const Point& p : mesh.vertices) result.add_vertex({p.x(), p.y(), p.z()});
  const auto vertex = [](std::uint32_t i) { return Mesh::VertexHandle(static_cast<int>(i)); };
  for (const Triangle& t : mesh.triangles) {
    result.add_face(vertex(t[0]), vertex(t[1]), vertex(t[2]));
  }
  return result;
}

TriangleMesh from_openmesh(const Mesh& mesh) {
  TriangleMesh result;
  for (const auto vertex : mesh.vertices()) {
    const auto& p = mesh.point(vertex);
    result.vertices.emplace_back(p[0], p[1], p[2]);
  }
  for (const auto face : mesh.faces()) {
    Triangle triangle;
    std::size_t corner = 0;
    for (const auto vertex : mesh.fv_range(face)) {
      triangle[corner++] = static_cast<std::uint32_t>(vertex.idx());
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

// At most `tolerance` where that is positive; down to so many triangles.
TriangleMesh decimated(const Mesh& start, bool flipping, double tolerance, std::size_t triangles) {
  Mesh mesh = start;
  mesh.request_vertex_status();
  mesh.request_edge_status();
  mesh.request_halfedge_status();
  mesh.request_face_status();
  mesh.request_face_normals();
  mesh.update_face_normals();
  {
    Decimater decimater(mesh);
    Quadric::Handle quadric;
    decimater.add(quadric);
    Hausdorff::Handle hausdorff;
    if (tolerance > 0) {
      decimater.add(hausdorff);
      decimater.module(hausdorff).set_tolerance(tolerance);
    }
    Flipping::Handle normals;
    if (flipping) decimater.add(normals);
    if (!decimater.initialize()) return {};
    decimater.decimate_to_faces(0, triangles);
  }
  mesh.garbage_collection();
  return from_openmesh(mesh);
}

}  // namespace

Tool openmesh_tool() {
  const auto sets = [](const TriangleMesh& start, double epsilon) {
    using enum OptionSet::Parameter;
    const auto mesh = std::make_shared<const Mesh>(to_openmesh(start));
    const auto to_tolerance = [=](bool flipping) {
      return [=](double tolerance) { return decimated(*mesh, flipping, tolerance * epsilon, 1); };
    };
    const auto to_count = [=](double tolerance) {
      return [=](double triangles) {
        return decimated(*mesh, true, tolerance, static_cast<std::size_t>(triangles));
      };
    };
    return std::vector<OptionSet>{
        {"ModQuadric, ModHausdorff, ModNormalFlipping", kTolerance, to_tolerance(true)},
        {"ModQuadric, ModHausdorff", kTolerance, to_tolerance(false)},
        {"ModQuadric, ModHausdorff of ε, ModNormalFlipping, to a number", kTriangles,
         to_count(epsilon)},
        {"ModQuadric, ModNormalFlipping, to a number", kTriangles, to_count(0)},
    };
  };
  return {"OpenMesh", "openmesh",
          std::to_string((OM_VERSION & 0xf0000) >> 16) + "." +
              std::to_string((OM_VERSION & 0x0ff00) >> 8),
          sets};
}

}  // namespace emax::benchmarks
