#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace emax::test {

// A run of the built program, as a person would see it.
struct ProgramRun {
  int exit_code;                     // 128 + signal where one ended it
  std::string output;                // standard output
  std::string errors;                // standard error
  std::uint64_t resident_bytes = 0;  // at most, as the system counts them
};

// A run that is under way; killed with this if it still is.
class EmaxProcess {
 public:
  EmaxProcess(const std::vector<std::string>& arguments, const std::filesystem::path& folder);
  ~EmaxProcess();
  EmaxProcess(const EmaxProcess&) = delete;
  EmaxProcess& operator=(const EmaxProcess&) = delete;

  void await_output(const std::string& text) const;  // until standard output holds it, or a minute
  void signal(int number) const;
  ProgramRun wait();

 private:
  std::filesystem::path streams_;
  int pid_;
};

// Runs `emax` with these arguments in `folder`, which must exist. `stop_after_seconds` > 0 sends
// SIGINT then.
ProgramRun run_emax(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                    double stop_after_seconds = 0);

std::string file_text(const std::filesystem::path& path);

// Names of the files in a folder, sorted.
std::vector<std::string> files_in(const std::filesystem::path& folder);

// A bumpy sphere's points as XYZ text, and its mesh as OFF text.
void write_scan(const std::filesystem::path& path, std::size_t points, std::uint64_t seed);
void write_surface(const std::filesystem::path& path, unsigned rings, unsigned segments);

}  // namespace emax::test
