// The certificate of a mesh.
#include "host/report/certificate_file.h"

#include "tests/fuzz/files.h"

namespace emax::fuzz {

void read(Input input) {
  const std::string text = to_json_text(read_certificate(write("file.json", input)));
  require(to_json_text(read_certificate(write("file.json", bytes_of(text)))) == text,
          "a certificate that was written is read the same");
}

std::vector<std::string> seeds() {
  Certificate certificate;
  certificate.mesh_file = "a.ply";
  certificate.mesh_sha256 = certificate.cloud_sha256 = std::string(64, '0');
  certificate.cloud_file = "a.xyz";
  certificate.epsilon = 0.5;
  certificate.error.excluded = {3};
  certificate.error.excluded_distances = {0.75};
  const std::string one_sided = to_json_text(certificate);
  certificate.reference = ReferenceBound{.file = "a.ply.reference.ply", .epsilon_back = 0.5};
  return {one_sided, to_json_text(certificate)};
}

}  // namespace emax::fuzz
