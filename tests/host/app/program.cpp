#include "tests/host/app/program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/resource.h>
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

EmaxProcess::EmaxProcess(const std::vector<std::string>& arguments,
                         const std::filesystem::path& folder) {
  // Outside of `folder`, whose content tests look at.
  static int count = 0;
  streams_ = fmt::format("{}.streams{}", folder.string(), count++);
  std::filesystem::create_directories(streams_);
  const std::string output = streams_ / "out", errors = streams_ / "err";
  std::vector<std::string> words = {EMAX_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_ = fork();
  if (pid_ == 0) {
    const int out = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int err = open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (dup2(out, 1) < 0 || dup2(err, 2) < 0 || chdir(folder.c_str()) != 0) _exit(126);
    execv(argv[0], argv.data());
    _exit(127);
  }
}

EmaxProcess::~EmaxProcess() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  std::filesystem::remove_all(streams_);
}

void EmaxProcess::await_output(const std::string& text) const {
  for (int i = 0; i < 60'000; ++i) {
    if (file_text(streams_ / "out").find(text) != std::string::npos) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

void EmaxProcess::signal(int number) const { kill(pid_, number); }

ProgramRun EmaxProcess::wait() {
  int status = 0;
  rusage usage = {};
  wait4(pid_, &status, 0, &usage);
  pid_ = -1;
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {code, file_text(streams_ / "out"), file_text(streams_ / "err"),
          static_cast<std::uint64_t>(usage.ru_maxrss) * 1024};
}

ProgramRun run_emax(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                    double stop_after_seconds) {
  EmaxProcess process(arguments, folder);
  if (stop_after_seconds > 0) {
    std::this_thread::sleep_for(std::chrono::duration<double>(stop_after_seconds));
    process.signal(SIGINT);
  }
  return process.wait();
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
