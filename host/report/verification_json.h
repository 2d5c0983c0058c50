#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/report/certificate_file.h"

namespace emax {

// The content of --json of `verify`. The keys are stable.
struct VerificationReport {
  std::string certificate_file, mesh_file, cloud_file;  // as they were found
  std::string reference_file;                           // empty: none
  std::string page, picture;                 // files of --report and --picture; empty: none
  const Certificate* certificate = nullptr;  // its claims
  std::optional<double> e_max;               // recomputed, if the check reached it
  std::vector<std::string> reasons;          // why the certificate does not hold; empty: it holds
};

std::string to_json_text(const VerificationReport& report);

}  // namespace emax
