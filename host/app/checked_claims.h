#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/app/commands.h"
#include "host/app/scan.h"
#include "host/report/certificate_file.h"

namespace emax {

// What recomputing a certificate's claims gave.
struct CheckedClaims {
  std::vector<std::string> reasons;  // why it does not hold; empty: it holds
  std::optional<double> e_max;       // recomputed, if the check reached it
};

// Recomputes what the certificate of `options` claims of its files, with their checksums. Throws
// Error for files that are missing or cannot be read.
CheckedClaims check_files(const VerifyOptions& options);

// Recomputes what a certificate claims of these, without the checksums of their files. `reference`
// is that of a two-sided bound, nullptr for a one-sided one.
CheckedClaims check_claims(const Certificate& certificate, const TriangleMesh& mesh,
                           const Scan& scan, const TriangleMesh* reference);

}  // namespace emax
