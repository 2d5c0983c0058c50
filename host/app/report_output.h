#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "host/app/certified_result.h"
#include "host/app/facts.h"
#include "host/app/report_options.h"
#include "host/report/report_measurement.h"

namespace emax {

// What every report says of a cloud and a mesh, with pictures as `wanted` asks for them.
// `excluded`: indices of the cloud; `epsilon`: in the cloud's unit, nothing without a tolerance.
ReportData measured_report(const ReportOptions& wanted, const Scan& scan, MeshView mesh,
                           const std::vector<std::uint32_t>& excluded,
                           std::optional<double> epsilon);

// The same with all that is known of a mesh that a command found for a tolerance. `mesh_file`:
// where it was written, if it keeps the bounds; `written`: what write_result() gave, if it does.
ReportData report_of_result(const ReportOptions& wanted, const CertifiedResult& result,
                            const std::filesystem::path& mesh_file,
                            const std::optional<WrittenResult>& written);

// The file as a report names it: without folders.
ReportInput report_input(std::string name, const std::filesystem::path& file, std::string sha256);

// `text` as one word of a shell's command.
std::string shell_word(const std::string& text);

// Writes what is wanted, the page and the picture together or none, and prints their names. The
// lines of `facts` so far stand in the page. Throws Error if a file cannot be written.
void write_report(const ReportOptions& wanted, ReportData report, Facts& facts);

}  // namespace emax
