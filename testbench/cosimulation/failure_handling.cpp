#include "testbench/cosimulation/failure_handling.h"

#include <spawn.h>
#include <sys/wait.h>

#include <cstdio>

#include "sw_model/base/error.h"

extern char** environ;

namespace emax {

namespace fs = std::filesystem;

int run_replay(const fs::path& folder, const std::vector<std::string>& arguments) {
  const fs::path program = replay_program();
  std::vector<std::string> words = {program.string(), folder.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  std::fflush(stdout);
  pid_t child = 0;
  int status = 0;
  if (posix_spawn(&child, program.c_str(), nullptr, nullptr, argv.data(), environ) != 0 ||
      waitpid(child, &status, 0) != child || !WIFEXITED(status)) {
    std::fprintf(stderr, "%s: cannot be run; build it beside this program\n", program.c_str());
    return 2;
  }
  return WEXITSTATUS(status);
}

fs::path keep_failure(const Failure& failure, const ElementFactory& make_element,
                      const fs::path& parent, std::uint64_t window) {
  std::printf("\nmismatch in %sshrinking it ...\n", describe(failure).c_str());
  std::fflush(stdout);
  const Failure small = shrink(failure, make_element);
  fs::path folder = parent / folder_name(small);
  write_failure(folder, small);
  const ElementRun& run = small.runs.back();
  std::printf("%zu pairs, %zu records left\n", run.pairs.size(), run.records.size());
  const int code = run_replay(folder, {"--write", "--window", std::to_string(window)});
  if (code == 0) std::printf("the element with probes shows no mismatch; only input.txt is kept\n");
  const fs::path path = fs::absolute(folder);
  std::printf("kept in %s; replay: sh %s/replay.sh; waveform: gtkwave %s/waveform.gtkw\n",
              path.c_str(), path.c_str(), path.c_str());
  return folder;
}

}  // namespace emax
