#include "host/app/run_identity.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <iterator>

#include "hls/kernel/command_words.h"
#include "host/files/input_file.h"
#include "host/files/mesh_file.h"
#include "host/files/sha256.h"

namespace emax {
namespace {

// The checksum of both programs: the same bytes of results are promised only for one build.
std::string build() {
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
  const std::string both =
      sha256_of_file(program) + sha256_of_file(program.parent_path() / "emax_worker");
  return sha256(both).substr(0, 16);
}

// The C library chooses its functions by these features.
std::string processor() {
#if defined(__x86_64__)
  std::string text = "x86-64";
  if (__builtin_cpu_supports("avx2") != 0) text += " avx2";
  if (__builtin_cpu_supports("fma") != 0) text += " fma";
  return text;
#elif defined(__aarch64__)
  return "aarch64";
#else
#error "emax: say here what this processor's results depend on"
#endif
}

}  // namespace

RunSettings run_settings(const OptimizeOptions& options, const OptimizeSettings& settings,
                         const std::string& cloud_sha256, double epsilon) {
  RunSettings run = {
      {"cloud.sha256", cloud_sha256},
      {"cloud.skip_invalid", options.common.reading.skip_invalid ? "true" : "false"},
      {"max_error", fmt::format("{}", epsilon)},
      {"exclude_outliers", fmt::format("{}", parse_share(options.common.excluded_share))},
      {"method", settings.reference_method.empty() ? settings.method : settings.reference_method},
      {"decimator", settings.decimator},
      {"bound", settings.epsilon_back ? "two-sided" : "one-sided"},
      {"closed", settings.closed ? "true" : "false"},
      {"features", settings.features},
      {"hole_reach", settings.hole_reach ? fmt::format("{}", *settings.hole_reach) : "max_error"},
      {"mesh.ending", lower_case_ending(settings.output)},
      {"seed", fmt::format("{}", settings.seed)},
  };
  if (!options.common.reading.left_out_classes.empty()) {
    run.emplace_back("cloud.left_out_classes",
                     fmt::format("{}", fmt::join(options.common.reading.left_out_classes, ",")));
  }
  if (takes_bound(settings.decimator)) run.emplace_back(kBoundSetting, "");
  for (auto& value : named_values(settings.config)) {
    if (value.first != "search.budget") run.push_back(std::move(value));  // it may grow
  }
  for (auto& value : program_identity()) run.push_back(std::move(value));
  return run;
}

RunSettings program_identity() {
  return {{"emax", EMAX_VERSION},
          {"kernel", fmt::format("{}", kKernelVersion)},
          {"libraries", EMAX_WORKER_LIBRARIES},
          {"processor", processor()},
          {"build", build()}};
}

std::string checksum(const DecimationBound& bound) {
  std::string bytes = mesh_bytes(bound.reference, MeshFormat::kPly);
  for (const std::uint32_t outlier : bound.outliers) bytes += fmt::format(" {}", outlier);
  return sha256(bytes);
}

std::string describe(const RunLog& log, std::uint64_t budget) {
  const std::string folder = log.folder().string();
  const auto& logged = log.evaluations();
  const auto count = std::distance(logged.begin(), logged.lower_bound(budget));
  std::string text = logged.empty() ? "starts in " + folder
                                    : fmt::format("continues in {}: {} of {} evaluations are there",
                                                  folder, count, budget);
  const RecordFile::Loss loss = log.loss();
  if (loss.torn > 0) text += fmt::format("; {} bytes of a torn record were cut off", loss.torn);
  if (loss.damaged > 0) text += fmt::format("; {} damaged bytes were skipped", loss.damaged);
  return text;
}

}  // namespace emax
