#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "host/app/checked_claims.h"
#include "host/python/arrays.h"
#include "host/python/bindings.h"
#include "sw_model/base/error.h"

namespace nb = nanobind;

namespace emax {
namespace {

using Claims = std::pair<std::vector<std::string>, std::optional<double>>;

Claims verify_arrays(const std::string& text, const GivenMesh& mesh, const GivenCloud* cloud,
                     const GivenMesh* vertices, const GivenMesh* reference) {
  const Certificate certificate = parse_certificate(text, "certificate");
  if (certificate.reference && reference == nullptr) {
    throw Error("reference: the certificate is two-sided; give the reference too");
  }
  if (certificate.vertices_of_mesh ? vertices == nullptr : cloud == nullptr) {
    throw Error(certificate.vertices_of_mesh
                    ? "cloud: the points are the vertices of a mesh; give that mesh"
                    : "cloud: give the cloud that was certified");
  }
  const Scan scan =
      certificate.vertices_of_mesh ? vertices_of("cloud", vertices->mesh) : cloud->scan;
  const CheckedClaims checked = check_claims(certificate, mesh.mesh, scan,
                                             certificate.reference ? &reference->mesh : nullptr);
  return {checked.reasons, checked.e_max};
}

Claims verify_files(const std::string& certificate, const std::string& mesh,
                    const std::string& cloud, const std::string& reference) {
  VerifyOptions options;
  options.certificate = certificate;
  options.mesh = mesh;
  options.cloud = cloud;
  options.reference = reference;
  const CheckedClaims checked = check_files(options);
  return {checked.reasons, checked.e_max};
}

}  // namespace

void bind_verify(nb::module_& module) {
  const nb::call_guard<nb::gil_scoped_release> released;
  module.def("verify_arrays", &verify_arrays, nb::arg("certificate"), nb::arg("mesh"),
             nb::arg("cloud").none(), nb::arg("vertices").none(), nb::arg("reference").none(),
             released);
  module.def("verify_files", &verify_files, nb::arg("certificate"), nb::arg("mesh"),
             nb::arg("cloud"), nb::arg("reference"), released);
}

}  // namespace emax
