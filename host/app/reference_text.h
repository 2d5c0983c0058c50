#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "host/geometry/mesh_topology.h"
#include "host/geometry/triangle_mesh.h"
#include "host/report/certificate_file.h"

namespace emax {

// A proven upper bound on the distance of every point of the reference, the inside of its triangles
// included, from the mesh. At most epsilon exactly where that can be proven; within 1% of the truth
// otherwise.
double reference_to_mesh(const TriangleMesh& reference, const TriangleMesh& mesh, double epsilon);

// "1 component, closed, genus 0", and whether the reference has the same.
std::string describe(const MeshTopology& mesh, const std::optional<MeshTopology>& reference);

// What is certified between mesh and reference, two lines.
void print(const ReferenceBound& bound, double epsilon, double width,
           const std::filesystem::path& reference);

}  // namespace emax
