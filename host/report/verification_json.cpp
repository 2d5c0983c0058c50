#include "host/report/verification_json.h"

#include "host/report/json_parts.h"

namespace emax {

std::string to_json_text(const VerificationReport& r) {
  const Certificate& c = *r.certificate;
  const Json json = {{"schema", "emax-verification-1"},
                     {"holds", r.reasons.empty()},
                     {"reasons", r.reasons},
                     {"certificate", r.certificate_file},
                     {"mesh", r.mesh_file},
                     {"cloud", r.cloud_file},
                     {"reference_file", r.reference_file.empty() ? Json() : Json(r.reference_file)},
                     {"triangles", c.triangles},
                     {"points", c.error.points},
                     {"excluded", excluded_to_json(c.error)},
                     {"epsilon", c.epsilon},
                     {"e_max", r.e_max ? Json(*r.e_max) : Json()},
                     {"topology", to_json(c.topology)},
                     {"reference", c.reference ? to_json(*c.reference) : Json()},
                     {"report", r.page.empty() ? Json() : Json(r.page)},
                     {"picture", r.picture.empty() ? Json() : Json(r.picture)}};
  return json.dump(2) + "\n";
}

}  // namespace emax
