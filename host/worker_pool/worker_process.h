#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "host/worker_pool/message.h"

namespace emax {

// File descriptors a worker finds open when it starts.
inline constexpr int kChannelFd = 3;  // stream socket: requests in, answers out
inline constexpr int kPointsFd = 4;   // file that holds the "points" message

// Owns one descriptor.
class FileDescriptor {
 public:
  explicit FileDescriptor(int fd = -1) : fd_(fd) {}
  FileDescriptor(FileDescriptor&& other) noexcept;
  FileDescriptor& operator=(FileDescriptor&& other) noexcept;
  ~FileDescriptor();
  int get() const { return fd_; }

 private:
  int fd_;
};

// A file in memory that holds these bytes and cannot be changed any more.
FileDescriptor sealed_file(std::span<const std::uint8_t> bytes);

// One worker process in a process group of its own, killed with its group and reaped when this
// goes. What it prints is discarded. It ends by itself when the program that spawned it ends,
// because its channel hangs up.
class WorkerProcess {
 public:
  struct Command {
    std::filesystem::path program;
    std::uint64_t memory_limit = 0;  // bytes of address space; 0 for none
  };

  // Throws Error when the program cannot be started.
  WorkerProcess(const Command& command, const FileDescriptor& points);
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;
  ~WorkerProcess();

  int channel() const { return channel_.get(); }
  pid_t pid() const { return pid_; }

  // False when the worker does not take the message at once: it is gone or stuck.
  bool send(const Bytes& message) const;

  enum class Received { kNothing, kSome, kEnd };
  // Takes of what has arrived at most 16 MiB, without waiting.
  Received receive();
  // The next whole message. Throws Error when what arrived is none.
  std::optional<Message> next_message();

  // How the process ended, in words, after its channel did.
  Failure end();

 private:
  std::optional<int> reap(bool wait);

  FileDescriptor channel_;
  pid_t pid_ = -1;
  std::uint64_t longest_message_;
  Bytes arrived_;
};

}  // namespace emax
