#include "tests/host/app/program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include "tests/support/stimuli.h"

namespace emax::test {

std::string file_text(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

ProgramRun run_emax(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                    double stop_after_seconds) {
  // Outside of `folder`, whose content tests look at.
  const std::filesystem::path streams = folder.string() + ".streams";
  std::filesystem::create_directories(streams);
  const std::string output = streams / "out", errors = streams / "err";
  std::vector<std::string> words = {EMAX_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    const int out = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int err = open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (dup2(out, 1) < 0 || dup2(err, 2) < 0 || chdir(folder.c_str()) != 0) _exit(126);
    execv(argv[0], argv.data());
    _exit(127);
  }
  if (stop_after_seconds > 0) {
    std::this_thread::sleep_for(std::chrono::duration<double>(stop_after_seconds));
    kill(child, SIGINT);
  }
  int status = 0;
  waitpid(child, &status, 0);
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  ProgramRun run = {code, file_text(output), file_text(errors)};
  std::filesystem::remove_all(streams);
  return run;
}

std::vector<std::string> files_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

void write_scan(const std::filesystem::path& path, std::size_t points, std::uint64_t seed) {
  std::ofstream file(path);
  for (const Point& p : bumpy_sphere(4, 4, points, seed).cloud) {
    file << fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
  }
}

void write_surface(const std::filesystem::path& path, unsigned rings, unsigned segments) {
  const Stimulus s = bumpy_sphere(rings, segments, 0, 1);
  std::ofstream file(path);
  file << fmt::format("OFF\n{} {} 0\n", s.vertices.size(), s.triangles.size());
  for (const Point& p : s.vertices) file << fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
  for (const Triangle& t : s.triangles) file << fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
}

}  // namespace emax::test
