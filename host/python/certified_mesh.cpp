#include "host/python/certified_mesh.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <filesystem>

#include "host/files/atomic_file.h"
#include "host/files/input_file.h"
#include "host/files/mesh_file.h"
#include "host/files/sha256.h"
#include "host/report/certificate_file.h"
#include "host/report/json_parts.h"
#include "sw_model/base/error.h"

namespace nb = nanobind;

namespace emax {
namespace {

bool is_same(MeshView a, MeshView b) {
  return std::ranges::equal(a.vertices, b.vertices) && std::ranges::equal(a.triangles, b.triangles);
}

// Gives a file its name and checksum in the certificate.
void name_file(Json& json, const OutputFile& file) {
  json["file"] = file.path.filename().string();
  json["sha256"] = sha256(file.bytes);
}

}  // namespace

std::string arrays_path(const std::string& mesh) { return mesh + ".cloud.ply"; }

void save(const CertifiedMesh& made, const std::string& path) {
  check_output(path, mesh_endings());
  const MeshFormat format = mesh_format(path);
  if (!is_same(as_stored(made.mesh, storage_of(format)).view(), made.mesh.view())) {
    throw Error(path +
                ": this format would round the certified coordinates; save .ply, .obj or .off");
  }
  Json certificate = Json::parse(made.certificate);
  std::vector<OutputFile> files;
  const auto add = [&](const std::filesystem::path& file, std::string bytes, const char* key) {
    files.push_back({file, std::move(bytes)});
    name_file(certificate[key], files.back());
  };
  if (made.arrays) {
    add(arrays_path(path), mesh_bytes(*made.arrays, MeshFormat::kPly), "cloud");
    if (made.arrays_are_reference) name_file(certificate["reference"], files.back());
  }
  if (made.reference) {
    add(reference_path(path), mesh_bytes(*made.reference, MeshFormat::kPly), "reference");
  }
  add(path, mesh_bytes(made.mesh, format), "mesh");
  files.push_back({certificate_path(path), certificate.dump(2) + "\n"});
  write_together(files);
}

CertifiedMesh certified_of_files(const std::string& mesh, const GivenCloud* arrays) {
  CertifiedMesh made;
  made.mesh = read_mesh(mesh);
  const Certificate certificate = read_certificate(certificate_path(mesh));
  made.certificate = read_input(certificate_path(mesh)).bytes;
  made.e_max = certificate.error.e_max_upper;
  if (certificate.reference) {
    made.back = certificate.reference->mesh_to_reference;
    made.reference = read_mesh(reference_path(mesh));
  }
  if (arrays != nullptr) made.arrays = TriangleMesh{arrays->scan.cloud.points, {}};
  return made;
}

void bind_certified_mesh(nb::module_& module) {
  using Self = nb::handle_t<CertifiedMesh>;
  const auto of = [](Self self) -> CertifiedMesh& { return nb::cast<CertifiedMesh&>(self); };
  const auto reference = nb::rv_policy::reference;
  nb::class_<CertifiedMesh>(module, "CertifiedMesh")
      .def_prop_ro(
          "vertices", [of](Self self) { return view_of(of(self).mesh.vertices, self); }, reference)
      .def_prop_ro(
          "faces", [of](Self self) { return view_of(of(self).mesh.triangles, self); }, reference)
      .def_prop_ro("has_reference",
                   [](const CertifiedMesh& self) { return self.reference.has_value(); })
      .def_prop_ro(
          "reference_vertices",
          [of](Self self) { return view_of(of(self).reference.value().vertices, self); }, reference)
      .def_prop_ro(
          "reference_faces",
          [of](Self self) { return view_of(of(self).reference.value().triangles, self); },
          reference)
      .def_ro("certificate", &CertifiedMesh::certificate)
      .def_ro("e_max", &CertifiedMesh::e_max)
      .def_ro("back", &CertifiedMesh::back)
      .def_ro("interrupted", &CertifiedMesh::interrupted)
      .def("save", &save, nb::arg("path"), nb::call_guard<nb::gil_scoped_release>());
  module.def("certified_of_files", &certified_of_files, nb::arg("mesh"), nb::arg("arrays").none(),
             nb::call_guard<nb::gil_scoped_release>());
}

}  // namespace emax
