// The folder of a run: its settings, its log and a mesh.
#include "host/run_log/run_log.h"

#include <algorithm>

#include "tests/fuzz/files.h"

namespace emax::fuzz {
namespace {

constexpr std::string_view kHeader = "emaxrun1";

// The next part of an input, after two bytes with its size.
Input part(Input& input) {
  if (input.size() < 2) return {};
  const std::size_t size = std::min<std::size_t>(input[0] + 256u * input[1], input.size() - 2);
  const Input bytes = input.subspan(2, size);
  input = input.subspan(2 + size);
  return bytes;
}

std::string as_part(std::string_view bytes) {
  return std::string{static_cast<char>(bytes.size()), static_cast<char>(bytes.size() >> 8)} +
         std::string(bytes);
}

// Each evaluation as it is kept, so that those with a NaN can be compared.
std::vector<std::vector<std::uint8_t>> kept(const RunLog& log) {
  std::vector<std::vector<std::uint8_t>> records;
  for (const auto& [index, evaluation] : log.evaluations()) records.push_back(encode(evaluation));
  return records;
}

const RunSettings kSettings = {{"cloud", "abc"}};

}  // namespace

// An input is the settings, the end of the log, and the records before that end. A fuzzer does not
// find a CRC, so the records get theirs here; the end of the log may be anything.
void read(Input input) {
  const std::filesystem::path run = folder() / "run";
  std::filesystem::remove_all(run);
  std::filesystem::create_directory(run);
  write("run/settings.json", part(input));
  const Input end = part(input);
  std::vector<std::uint8_t> log(kHeader.begin(), kHeader.end());
  while (input.size() >= 2) {
    const std::vector<std::uint8_t> record = record_bytes(part(input));
    log.insert(log.end(), record.begin(), record.end());
  }
  log.insert(log.end(), end.begin(), end.end());
  write("run/evaluations.log", log);

  std::vector<std::vector<std::uint8_t>> evaluations;
  {
    RunLog opened(run, kSettings);
    evaluations = kept(opened);
    opened.give_budget(20);
  }
  const RunLog again(run, kSettings);
  require(kept(again) == evaluations, "a log that was opened holds the same evaluations again");
  require(again.loss().torn == 0, "a torn end is cut off once");
}

std::vector<std::string> seeds() {
  LoggedEvaluation measured;
  measured.genes = {0.1, 3};
  measured.triangles = 100;
  measured.walked = 0.5;
  measured.mesh_crc = 7;
  LoggedEvaluation failed;
  failed.index = 1;
  failed.failure = "timed out";
  const auto as_text = [](const LoggedEvaluation& evaluation) {
    const std::vector<std::uint8_t> bytes = encode(evaluation);
    return as_part({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  };
  return {
      as_part("{\"cloud\": \"abc\"}") + as_part("torn") + as_text(measured) + as_text(failed),
      as_part("{\"cloud\": \"abc\", \"budgets\": \"20 40\"}") + as_part("") + as_text(measured)};
}

}  // namespace emax::fuzz
