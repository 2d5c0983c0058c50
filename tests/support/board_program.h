#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>

namespace emax::test {

// `emax_board` while this lives: the simulated board behind a pseudo-terminal at path().
class BoardProgram {
 public:
  explicit BoardProgram(const std::string& program)
      : link_(std::filesystem::temp_directory_path() / ("emax_board." + std::to_string(getpid()))) {
    child_ = fork();
    if (child_ == 0) {
      const int nowhere = open("/dev/null", O_WRONLY);
      dup2(nowhere, 1);
      execl(program.c_str(), program.c_str(), "--link", link_.c_str(), nullptr);
      _exit(127);
    }
    for (int waited = 0; !std::filesystem::is_symlink(link_); ++waited) {
      if (waited == 1000) throw std::runtime_error(program + " does not start");
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  ~BoardProgram() {
    kill(child_, SIGINT);
    waitpid(child_, nullptr, 0);
  }
  BoardProgram(const BoardProgram&) = delete;
  BoardProgram& operator=(const BoardProgram&) = delete;

  std::string path() const { return link_; }

 private:
  std::filesystem::path link_;
  pid_t child_;
};

}  // namespace emax::test
