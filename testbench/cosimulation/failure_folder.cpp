#include "testbench/cosimulation/failure_folder.h"

#include <cctype>
#include <fstream>
#include <sstream>

#include "sw_model/base/error.h"

namespace emax {
namespace {

namespace fs = std::filesystem;

void require(bool done, const fs::path& path) {
  if (!done) throw Error(path.string() + ": cannot be written; check the folder's permissions");
}

std::string commented(const std::string& text) {
  std::istringstream lines(text);
  std::string all;
  for (std::string line; std::getline(lines, line);) all += "# " + line + "\n";
  return all;
}

// Escapes text for the shell, as a default value between braces.
std::string quoted(const std::string& text) {
  std::string all;
  for (const char c : text) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '/' || c == '.' ||
                       c == '_' || c == '-';
    all += plain ? std::string(1, c) : std::string("\\") + c;
  }
  return all;
}

}  // namespace

fs::path replay_program() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path() / "emax_cosim_replay";
}

std::string folder_name(const Failure& failure) {
  std::string name;
  for (const char c : failure.test) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (plain) name += c;
    if (!plain && !name.empty() && name.back() != '-') name += '-';
  }
  return name + "-" + std::to_string(failure.seed);
}

std::string describe(const Failure& failure) {
  const Mismatch& m = failure.mismatch;
  std::string text = "test '" + failure.test + "', seed " + std::to_string(failure.seed) + ": " +
                     m.stream + ", sample " + std::to_string(m.sample);
  if (m.pair) text += ", pair " + std::to_string(*m.pair);
  return text + ", cycle " + std::to_string(m.cycle) + ":\n  " + m.what + "\n";
}

void write_failure(const fs::path& folder, const Failure& failure) {
  std::error_code error;
  fs::create_directories(folder, error);
  const fs::path input = folder / "input.txt", script = folder / "replay.sh";
  std::ofstream out(input);
  out << commented(describe(failure)) << "test " << failure.test << "\nseed " << failure.seed
      << "\nslot_bits " << failure.slot_bits << "\nmutant " << failure.mutant << "\nruns "
      << failure.runs.size() << '\n';
  for (const ElementRun& run : failure.runs) write_run(out, run);
  out.close();
  require(static_cast<bool>(out), input);

  // The script runs from any folder, with the program that wrote it.
  std::ofstream line(script);
  line << "#!/bin/sh\nprogram=${EMAX_COSIM_REPLAY:-" << quoted(replay_program().string())
       << "}\n[ -x \"$program\" ] || {\n"
          "  echo \"replay.sh: $program is not there: build it, or set EMAX_COSIM_REPLAY to "
          "the\"\\\n"
          "    \"emax_cosim_replay of another build\" >&2\n  exit 2\n}\n"
          "exec \"$program\" \"$(cd \"$(dirname \"$0\")\" && pwd)\" \"$@\"\n";
  line.close();
  require(static_cast<bool>(line), script);
  fs::permissions(script, fs::perms::owner_all | fs::perms::group_read | fs::perms::others_read,
                  error);
}

Failure read_failure(const fs::path& folder) {
  const fs::path input = folder / "input.txt";
  std::ifstream in(input);
  if (!in) throw Error(input.string() + ": cannot be read; --replay takes a failure's folder");
  try {
    Failure failure;
    std::size_t runs = 0;
    while (runs == 0) {
      std::string text;
      if (!std::getline(in, text)) throw Error("the line 'runs N' is missing");
      std::istringstream line(text.substr(0, text.find('#')));
      std::string word;
      if (!(line >> word)) continue;
      if (word == "test") {
        std::getline(line >> std::ws, failure.test);
      } else if (word == "seed") {
        line >> failure.seed;
      } else if (word == "slot_bits") {
        line >> failure.slot_bits;
      } else if (word == "mutant") {
        line >> failure.mutant;
      } else if (word == "runs") {
        line >> runs;
      } else {
        throw Error("'" + text + "' is not a line of it");
      }
      if (line.fail()) throw Error("'" + text + "' needs a number");
    }
    for (std::size_t i = 0; i < runs; ++i) failure.runs.push_back(read_run(in));
    return failure;
  } catch (const Error& error) {
    throw Error(input.string() + ": " + error.what());
  }
}

}  // namespace emax
