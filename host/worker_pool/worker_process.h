#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "host/worker_pool/message.h"

namespace emax {

// File descriptors that are open when a worker starts.
inline constexpr int kChannelFd = 3;  // stream socket: requests in, answers out
inline constexpr int kPointsFd = 4;   // a file with the "points" message

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

// A file in memory that holds these bytes and can no longer be changed.
FileDescriptor sealed_file(std::span<const std::uint8_t> bytes);

// The one that is given, or emax_worker beside the running program.
std::filesystem::path worker_program(const std::filesystem::path& given);

// One worker process in its own process group. The destructor kills the group and reaps the
// process. Its output is discarded. It ends by itself when the program that started it ends,
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

  // Returns false if the worker does not take the message at once: it has ended or is stuck.
  bool send(const Bytes& message) const;

  enum class Received { kNothing, kSome, kEnd };
  // Takes at most 16 MiB of the bytes that have arrived, without waiting.
  Received receive();
  // The next whole message, if it has arrived. Throws Error if the bytes are not a message.
  std::optional<Message> next_message();

  // Describes how the process ended. Call this after its channel closed.
  Failure end();

 private:
  std::optional<int> reap(bool wait);

  FileDescriptor channel_;
  pid_t pid_ = -1;
  std::uint64_t longest_message_;
  Bytes arrived_;
};

}  // namespace emax
