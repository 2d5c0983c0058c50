#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "host/decimate/chain_parameters.h"
#include "host/geometry/mesh_validity.h"
#include "host/geometry/point_cloud.h"
#include "sw_model/certificate.h"
#include "sw_model/emax_model.h"
#include "sw_model/normalization.h"

namespace emax {

// What a certificate says of a mesh and its cloud, apart from how the mesh was found. It holds no
// time, host, path, job count or device: the same run gives the same bytes anywhere.
struct Certificate {
  std::string mesh_file, mesh_sha256;  // file names without folders
  std::string cloud_file, cloud_sha256;
  bool skip_invalid = false;  // how the cloud was read
  double epsilon = 0;         // in the cloud's unit
  CertifiedError error;       // indices are the file's
  EmaxResult kernel = {};     // over the kept points; the index is the file's
  std::size_t vertices = 0, triangles = 0;
  MeshValidity validity;
  Normalization transform;
  // How it was found.
  ChainSettings chain;
  std::uint64_t seed = 0, evaluations = 0;
};

// "<mesh>.certificate.json", beside the mesh.
std::filesystem::path certificate_path(const std::filesystem::path& mesh);

std::string to_json_text(const Certificate& certificate);

// Throws Error naming the file where it is not a certificate this program can check.
Certificate read_certificate(const std::filesystem::path& path);

}  // namespace emax
