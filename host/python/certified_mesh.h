#pragma once

#include <nanobind/nanobind.h>

#include <optional>
#include <string>

#include "host/python/arrays.h"

namespace emax {

// A mesh with its certificate, as it is in memory before it is saved.
struct CertifiedMesh {
  TriangleMesh mesh;
  std::string certificate;                // its text; mesh and arrays have the names of kMeshName
  std::optional<TriangleMesh> reference;  // unless it is the mesh that was given
  // The arrays that the certificate speaks of, where no file holds them: a cloud, or the mesh that
  // was given. save() writes them.
  std::optional<TriangleMesh> arrays;
  bool arrays_are_reference = false;  // of a two-sided bound: the arrays hold it
  double e_max = 0;
  std::optional<double> back;
  bool interrupted = false;
};

// The name of a mesh in a certificate that is not saved.
inline constexpr const char* kMeshName = "mesh.ply";
// "part.ply.cloud.ply": the file for arrays, beside the mesh.
std::string arrays_path(const std::string& mesh);

// Writes the mesh, the certificate and, where no file holds them, the reference and the arrays: all
// or none. Throws Error for a format that would round the mesh, and as write_together().
void save(const CertifiedMesh& made, const std::string& path);

// The result of `emax optimize`, as it wrote it. `arrays`: the cloud, where it was one of arrays.
CertifiedMesh certified_of_files(const std::string& mesh, const GivenCloud* arrays);

void bind_certified_mesh(nanobind::module_& module);

}  // namespace emax
