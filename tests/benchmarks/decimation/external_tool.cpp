#include "tests/benchmarks/decimation/external_tool.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "host/geometry/bounds.h"
#include "sw_model/base/error.h"
#include "tests/benchmarks/decimation/raw_mesh.h"

namespace emax::benchmarks {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

class Folder {
 public:
  Folder() {
    std::string pattern = (fs::temp_directory_path() / "emax_decimation_XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw Error("cannot make a folder " + pattern);
    path_ = pattern;
    fs::create_directories(path_ / "start");
    fs::create_directories(path_ / "result");
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  fs::path operator/(const char* name) const { return path_ / name; }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string last_line(const fs::path& path) {
  std::ifstream file(path);
  std::string line, last;
  while (std::getline(file, line)) {
    if (!line.empty()) last = line;
  }
  return last;
}

class Process {
 public:
  // Standard error goes to `errors`.
  Process(const std::string& command, const fs::path& folder, const fs::path& errors)
      : errors_(errors) {
    std::array<int, 2> ends;
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
      throw Error("cannot open a channel to " + command);
    }
    channel_ = ends[0];
    const std::string line = "exec " + command + " \"$0\"";
    pid_ = fork();
    if (pid_ == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      dup2(ends[1], STDIN_FILENO);
      dup2(ends[1], STDOUT_FILENO);
      dup2(open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
      execl("/bin/sh", "sh", "-c", line.c_str(), folder.c_str(), nullptr);
      _exit(127);
    }
    close(ends[1]);
    if (pid_ < 0) {
      close(channel_);
      throw Error("cannot start " + command);
    }
  }
  ~Process() {
    close(channel_);
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  bool running() const { return pid_ > 0; }

  // What is wrong with sending shows in the answer.
  void send(const json& request) const {
    const std::string line = request.dump() + "\n";
    for (std::size_t sent = 0; sent < line.size();) {
      const ssize_t n = ::send(channel_, line.data() + sent, line.size() - sent, MSG_NOSIGNAL);
      if (n <= 0) return;
      sent += static_cast<std::size_t>(n);
    }
  }

  json answer() {
    std::size_t end;
    while ((end = arrived_.find('\n')) == std::string::npos) {
      std::array<char, 4096> bytes;
      const ssize_t n = read(channel_, bytes.data(), bytes.size());
      if (n <= 0) throw Error(ended());
      arrived_.append(bytes.data(), static_cast<std::size_t>(n));
    }
    const std::string line = arrived_.substr(0, end);
    arrived_.erase(0, end + 1);
    json answer = json::parse(line, nullptr, false);
    if (!answer.is_object()) throw Error("it answers '" + line + "'");
    if (answer.contains("failure")) throw Error(answer["failure"].get<std::string>());
    return answer;
  }

 private:
  std::string ended() {
    int status = 0;
    kill(pid_, SIGKILL);  // it may have closed its channel alone; an ended one is not changed
    waitpid(pid_, &status, 0);
    pid_ = -1;
    std::string how = WIFSIGNALED(status)
                          ? "its process ended by signal " + std::to_string(WTERMSIG(status))
                          : "its process ended with " + std::to_string(WEXITSTATUS(status));
    const std::string said = last_line(errors_);
    return said.empty() ? how : how + ": " + said;
  }

  fs::path errors_;
  int channel_;
  pid_t pid_;
  std::string arrived_;
};

class Server {
 public:
  explicit Server(std::string command) : command_(std::move(command)) { start_process(); }

  const json& greeting() const { return greeting_; }

  void set_start(const TriangleMesh& mesh) {
    const Bounds box = bounds_of(mesh.vertices);
    middle_ = box.midpoint();
    width_ = box.width();
    TriangleMesh scaled = mesh;
    for (Point& p : scaled.vertices) p = (p - middle_) / width_;
    write_raw(folder_ / "start", scaled);
  }

  double width() const { return width_; }
  double seconds() const { return seconds_; }

  TriangleMesh simplified(std::size_t set, double parameter) {
    seconds_ = 0;
    if (!process_->running()) start_process();
    for (const char* name : {kVertexFile, kTriangleFile}) fs::remove(folder_ / "result" / name);
    process_->send({{"set", set}, {"parameter", parameter}});
    try {
      seconds_ = process_->answer().at("seconds").get<double>();
    } catch (const json::exception&) {
      throw Error("it does not answer how long the call took");
    }
    TriangleMesh mesh = read_raw(folder_ / "result");
    for (Point& p : mesh.vertices) p = p * width_ + middle_;
    return mesh;
  }

 private:
  void start_process() {
    process_.reset();
    process_ = std::make_unique<Process>(command_, folder_.path(), folder_ / "errors");
    greeting_ = process_->answer();
  }

  std::string command_;
  Folder folder_;
  std::unique_ptr<Process> process_;
  json greeting_;
  Point middle_ = Point::Zero();
  double width_ = 1, seconds_ = 0;
};

}  // namespace

Tool external_tool(const std::string& command) {
  const auto server = std::make_shared<Server>(command);
  const json& told = server->greeting();
  const auto sets = [server, names = told.at("sets")](const TriangleMesh& start, double epsilon) {
    using enum OptionSet::Parameter;
    server->set_start(start);
    std::vector<OptionSet> all;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const bool tolerance = names[i].at("parameter") == "tolerance";
      const double unit = tolerance ? epsilon / server->width() : 1;
      OptionSet set{names[i].at("name"), tolerance ? kTolerance : kTriangles,
                    [=](double parameter) { return server->simplified(i, unit * parameter); }};
      set.seconds = [server] { return server->seconds(); };
      all.push_back(std::move(set));
    }
    return all;
  };
  return {told.at("name"), "", told.at("version"), sets};
}

}  // namespace emax::benchmarks
