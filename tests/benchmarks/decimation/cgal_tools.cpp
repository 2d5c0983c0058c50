#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Polyhedral_envelope_filter.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/version.h>

#include <memory>
#include <optional>

#include "tests/benchmarks/decimation/tool.h"

namespace emax::benchmarks {
namespace {

namespace sms = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Stop = sms::Count_stop_predicate<Mesh>;
using NoFilter = sms::internal::Dummy_filter;
using NormalFilter = sms::Bounded_normal_change_filter<>;
using Envelope = sms::Polyhedral_envelope_filter<Kernel, NormalFilter>;

Mesh to_cgal(const TriangleMesh& mesh) {
  Mesh result;
  for (const Point& p : mesh.vertices) result.add_vertex({p.x(), p.y(), p.z()});
  using Vertex = Mesh::Vertex_index;
  for (const Triangle& t : mesh.triangles)
    result.add_face(Vertex(t[0]), Vertex(t[1]), Vertex(t[2]));
  return result;
}

TriangleMesh from_cgal(Mesh& mesh) {
  mesh.collect_garbage();
  TriangleMesh result;
  for (const auto vertex : mesh.vertices()) {
    const Kernel::Point_3& p = mesh.point(vertex);
    result.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto face : mesh.faces()) {
    Triangle triangle;
    std::size_t corner = 0;
    for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face))) {
      triangle[corner++] = static_cast<std::uint32_t>(vertex.idx());
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

// A closed mesh has three edges for two triangles.
std::size_t edges(double triangles) { return static_cast<std::size_t>(1.5 * triangles); }

template <class Filter>
TriangleMesh lindstrom_turk(const Mesh& start, std::size_t edges_left, double boundary_weight,
                            const Filter& filter) {
  Mesh mesh = start;
  const sms::internal::LindstromTurk_params weights(0.5, boundary_weight, 0);
  sms::edge_collapse(mesh, Stop(edges_left),
                     CGAL::parameters::get_cost(sms::LindstromTurk_cost<Mesh>(weights))
                         .get_placement(sms::LindstromTurk_placement<Mesh>(weights))
                         .filter(filter));
  return from_cgal(mesh);
}

template <class Policies, class Filter>
TriangleMesh garland_heckbert(const Mesh& start, std::size_t edges_left, const Filter& filter) {
  Mesh mesh = start;
  const Policies policies(mesh);
  sms::edge_collapse(mesh, Stop(edges_left),
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(policies.get_placement())
                         .filter(filter));
  return from_cgal(mesh);
}

using Planes = sms::GarlandHeckbert_plane_policies<Mesh, Kernel>;
using Triangles = sms::GarlandHeckbert_triangle_policies<Mesh, Kernel>;
using ProbablePlanes = sms::GarlandHeckbert_probabilistic_plane_policies<Mesh, Kernel>;
using ProbableTriangles = sms::GarlandHeckbert_probabilistic_triangle_policies<Mesh, Kernel>;

using Start = std::shared_ptr<const Mesh>;
using Parameter = OptionSet::Parameter;

template <class Policies>
OptionSet garland_heckbert_set(const std::string& name, const Start& mesh) {
  return {name + " policies, normals kept", Parameter::kTriangles, [=](double triangles) {
            return garland_heckbert<Policies>(*mesh, edges(triangles), NormalFilter());
          }};
}

}  // namespace

Tool cgal_lindstrom_turk_tool() {
  const auto sets = [](const TriangleMesh& start, double) {
    const auto mesh = std::make_shared<const Mesh>(to_cgal(start));
    std::vector<OptionSet> all;
    for (const auto& [name, weight] :
         {std::pair{"standard weights", 0.5}, {"boundary weight 10", 10}}) {
      all.push_back({name, Parameter::kTriangles, [=, boundary = weight](double triangles) {
                       return lindstrom_turk(*mesh, edges(triangles), boundary, NoFilter());
                     }});
    }
    all.push_back({"standard weights, normals kept", Parameter::kTriangles, [=](double triangles) {
                     return lindstrom_turk(*mesh, edges(triangles), 0.5, NormalFilter());
                   }});
    return all;
  };
  return {"CGAL Lindstrom–Turk", "cgal-lt", CGAL_VERSION_STR, sets};
}

Tool cgal_garland_heckbert_tool() {
  const auto sets = [](const TriangleMesh& start, double) {
    const auto mesh = std::make_shared<const Mesh>(to_cgal(start));
    std::vector<OptionSet> all = {
        garland_heckbert_set<Planes>("plane", mesh),
        garland_heckbert_set<ProbablePlanes>("probabilistic plane", mesh),
        garland_heckbert_set<ProbableTriangles>("probabilistic triangle", mesh),
        garland_heckbert_set<Triangles>("triangle", mesh),
        {"plane policies", Parameter::kTriangles, [=](double triangles) {
           return garland_heckbert<Planes>(*mesh, edges(triangles), NoFilter());
         }}};
    return all;
  };
  return {"CGAL Garland–Heckbert", "cgal-gh", CGAL_VERSION_STR, sets};
}

Tool cgal_envelope_tool() {
  const auto sets = [](const TriangleMesh& start, double epsilon) {
    const auto mesh = std::make_shared<const Mesh>(to_cgal(start));
    OptionSet set{"Lindstrom–Turk, standard weights, normals kept", Parameter::kTolerance,
                  [=](double tolerance) {
                    return lindstrom_turk(*mesh, 0, 0.5, Envelope(tolerance * epsilon));
                  }};
    set.finest = 0.5;
    set.coarsest = 2;
    return std::vector<OptionSet>{set};
  };
  return {"CGAL, polyhedral envelope", "cgal-envelope", CGAL_VERSION_STR, sets};
}

}  // namespace emax::benchmarks
