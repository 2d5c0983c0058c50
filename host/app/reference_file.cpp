#include "host/app/reference_file.h"

#include <utility>

#include "host/files/mesh_file.h"
#include "host/files/sha256.h"
#include "sw_model/base/parallel.h"

namespace emax {

ReferenceFile::ReferenceFile(std::filesystem::path path, const TriangleMesh& mesh,
                             std::span<const Point> points)
    : file_{std::move(path), mesh_bytes(mesh, MeshFormat::kPly)},
      mesh_(mesh),
      points_(points),
      sha256_(emax::sha256(file_.bytes)),
      topology_(topology_of(mesh.view())) {}

ReferenceFile::ReferenceFile(std::filesystem::path path, const TriangleMesh& mesh,
                             std::span<const Point> points, std::string sha256)
    : file_{std::move(path), {}},
      mesh_(mesh),
      points_(points),
      sha256_(std::move(sha256)),
      topology_(topology_of(mesh.view())) {}

void ReferenceFile::describe(ReferenceBound& bound, const std::vector<std::uint32_t>& excluded) {
  if (!points_to_reference_ || points_to_reference_->excluded != excluded) {
    points_to_reference_ = certify(points_, mesh_.view(), excluded, processor_threads());
  }
  describe_measured(bound, points_to_reference_->e_max_upper);
}

void ReferenceFile::describe_measured(ReferenceBound& bound, double points_to_reference) const {
  bound.file = path().filename().string();
  bound.sha256 = sha256_;
  bound.triangles = mesh_.triangles.size();
  bound.topology = topology_;
  bound.points_to_reference = points_to_reference;
}

}  // namespace emax
