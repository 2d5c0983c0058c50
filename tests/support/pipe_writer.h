#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

namespace emax::test {

// A FIFO into which bytes are written as another program would, at most once.
class PipeWriter {
 public:
  PipeWriter(std::filesystem::path path, std::string bytes) : path_(std::move(path)) {
    if (mkfifo(path_.c_str(), 0600) != 0) throw std::runtime_error("mkfifo failed");
    thread_ = std::thread([this, bytes = std::move(bytes)] { write_all(bytes); });
  }
  ~PipeWriter() {
    // Lets the writer go where nobody has read.
    close(open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
    thread_.join();
    std::filesystem::remove(path_);
  }
  PipeWriter(const PipeWriter&) = delete;
  PipeWriter& operator=(const PipeWriter&) = delete;

 private:
  void write_all(const std::string& bytes) const {
    sigset_t of_pipes;  // whoever reads may leave
    sigemptyset(&of_pipes);
    sigaddset(&of_pipes, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &of_pipes, nullptr);
    const int pipe = open(path_.c_str(), O_WRONLY | O_CLOEXEC);
    for (std::size_t at = 0; at < bytes.size();) {
      const ssize_t n = write(pipe, bytes.data() + at, bytes.size() - at);
      if (n < 0) break;
      at += static_cast<std::size_t>(n);
    }
    close(pipe);
  }

  std::filesystem::path path_;
  std::thread thread_;
};

// While this lives, standard input is what comes through a FIFO.
class InputFrom {
 public:
  explicit InputFrom(const std::filesystem::path& fifo) : before_(dup(STDIN_FILENO)) {
    const int pipe = open(fifo.c_str(), O_RDONLY | O_CLOEXEC);
    if (dup2(pipe, STDIN_FILENO) < 0) throw std::runtime_error("dup2 failed");
    close(pipe);
  }
  ~InputFrom() {
    dup2(before_, STDIN_FILENO);
    close(before_);
  }
  InputFrom(const InputFrom&) = delete;
  InputFrom& operator=(const InputFrom&) = delete;

 private:
  int before_;
};

}  // namespace emax::test
