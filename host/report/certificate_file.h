#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "host/files/cloud_file.h"
#include "host/geometry/mesh_topology.h"
#include "host/geometry/mesh_validity.h"
#include "host/geometry/point_cloud.h"
#include "host/parameters/chain_parameters.h"
#include "sw_model/certify/certificate.h"
#include "sw_model/model/emax_model.h"
#include "sw_model/model/normalization.h"

namespace emax {

// The proven distances between the mesh and the reference: upper bounds, in the cloud's unit.
struct ReferenceBound {
  std::string file, sha256;  // of the reference, without folders
  std::size_t triangles = 0;
  MeshTopology topology;  // of the reference
  double epsilon_back = 0;
  double mesh_to_reference = 0;    // from any point of the mesh, at most epsilon_back
  double reference_to_mesh = 0;    // from any point of the reference, at most epsilon
  double points_to_reference = 0;  // from the points that are not excluded
};

// The claims of a certificate about a mesh and its cloud, and how the mesh was found. It holds no
// time, host, path, job count or device: the same run gives the same bytes anywhere.
struct Certificate {
  std::string mesh_file, mesh_sha256;  // file names without folders
  std::string cloud_file, cloud_sha256;
  CloudReadOptions reading;       // how the cloud was read
  bool vertices_of_mesh = false;  // the cloud is the vertices that the triangles of a mesh file use
  double epsilon = 0;             // in the cloud's unit
  std::string unit;               // its name, where it is known
  CertifiedError error;           // indices are the file's
  EmaxResult kernel = {};         // over the points that are not excluded; the index is the file's
  std::size_t vertices = 0, triangles = 0;
  MeshValidity validity;
  MeshTopology topology;
  bool claims_valid = false;  // of a certificate that was read; a written one follows `validity`
  std::optional<ReferenceBound> reference;  // of a two-sided bound
  Normalization transform;
  // How it was found.
  ChainSettings chain;
  std::uint64_t seed = 0, evaluations = 0;
};

// "<mesh>.certificate.json" and "<mesh>.reference.ply", beside the mesh.
std::filesystem::path certificate_path(const std::filesystem::path& mesh);
std::filesystem::path reference_path(const std::filesystem::path& mesh);

std::string to_json_text(const Certificate& certificate);

// Throw Error naming the file if it is not a certificate that this program can check.
Certificate parse_certificate(std::string_view text, const std::string& name);
Certificate read_certificate(const std::filesystem::path& path);

}  // namespace emax
