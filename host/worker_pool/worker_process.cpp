#include "host/worker_pool/worker_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <csignal>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "sw_model/base/error.h"

namespace emax {
namespace {

constexpr std::chrono::milliseconds kEndGrace{1000};
constexpr std::size_t kReceiveBlock = std::size_t{1} << 18;
constexpr int kMostBlocks = 64;  // at once, so that deadlines are checked in between

[[noreturn]] void fail(const std::string& what, int error) {
  throw Error(what + ": " + std::strerror(error));
}

// Moves a descriptor out of the range of the numbers that a worker gets. There, dup2 onto itself
// may leave close-on-exec set, and one descriptor may overwrite another.
FileDescriptor moved_up(FileDescriptor low) {
  const int fd = fcntl(low.get(), F_DUPFD_CLOEXEC, 16);
  if (fd < 0) fail("cannot open a channel to a worker", errno);
  return FileDescriptor(fd);
}

struct SpawnFiles {
  SpawnFiles() { posix_spawn_file_actions_init(&actions); }
  ~SpawnFiles() { posix_spawn_file_actions_destroy(&actions); }
  posix_spawn_file_actions_t actions;
};

struct SpawnAttributes {
  SpawnAttributes() { posix_spawnattr_init(&attributes); }
  ~SpawnAttributes() { posix_spawnattr_destroy(&attributes); }
  posix_spawnattr_t attributes;
};

std::vector<std::string> single_threaded_environment() {
  std::vector<std::string> environment;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    if (std::string_view(*entry).starts_with("OMP_NUM_THREADS=")) continue;
    environment.emplace_back(*entry);
  }
  environment.emplace_back("OMP_NUM_THREADS=1");
  return environment;
}

std::vector<char*> pointers(std::vector<std::string>& strings) {
  std::vector<char*> result;
  for (std::string& s : strings) result.push_back(s.data());
  result.push_back(nullptr);
  return result;
}

}  // namespace

FileDescriptor::FileDescriptor(FileDescriptor&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)) {}

FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

FileDescriptor::~FileDescriptor() {
  if (fd_ >= 0) close(fd_);
}

FileDescriptor sealed_file(std::span<const std::uint8_t> bytes) {
  FileDescriptor file(memfd_create("emax points", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (file.get() < 0) fail("cannot make a file in memory for the workers", errno);
  for (std::size_t written = 0; written < bytes.size();) {
    const ssize_t n = write(file.get(), bytes.data() + written, bytes.size() - written);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("cannot fill a file in memory for the workers", errno);
    written += static_cast<std::size_t>(n);
  }
  fcntl(file.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE);
  return moved_up(std::move(file));
}

std::filesystem::path worker_program(const std::filesystem::path& given) {
  if (!given.empty()) return given;
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "emax_worker";
}

// A message was in the worker's memory, so it cannot be longer than the memory limit.
WorkerProcess::WorkerProcess(const Command& command, const FileDescriptor& points)
    : longest_message_(command.memory_limit != 0 ? std::min(command.memory_limit, kMaximumLength)
                                                 : kMaximumLength) {
  std::array<int, 2> ends;
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    fail("cannot open a channel to a worker", errno);
  }
  channel_ = moved_up(FileDescriptor(ends[0]));
  const FileDescriptor far_end = moved_up(FileDescriptor(ends[1]));

  SpawnFiles files;
  posix_spawn_file_actions_addopen(&files.actions, STDIN_FILENO, "/dev/null", O_RDWR, 0);
  posix_spawn_file_actions_adddup2(&files.actions, STDIN_FILENO, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files.actions, STDOUT_FILENO, STDERR_FILENO);
  posix_spawn_file_actions_adddup2(&files.actions, far_end.get(), kChannelFd);
  posix_spawn_file_actions_adddup2(&files.actions, points.get(), kPointsFd);
  posix_spawn_file_actions_addclosefrom_np(&files.actions, kPointsFd + 1);

  // A process group of its own, so that the terminal's Ctrl-C reaches only the program. Signals are
  // set as in a new program.
  SpawnAttributes attributes;
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setflags(&attributes.attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  posix_spawnattr_setpgroup(&attributes.attributes, 0);
  posix_spawnattr_setsigmask(&attributes.attributes, &none);
  posix_spawnattr_setsigdefault(&attributes.attributes, &all);

  std::vector<std::string> arguments = {command.program.string(),
                                        std::to_string(command.memory_limit)};
  std::vector<std::string> environment = single_threaded_environment();
  const int error =
      posix_spawn(&pid_, command.program.c_str(), &files.actions, &attributes.attributes,
                  pointers(arguments).data(), pointers(environment).data());
  if (error != 0) {
    fail("cannot start the worker program " + command.program.string() +
             " (it must lie beside the program that uses it)",
         error);
  }
}

WorkerProcess::~WorkerProcess() {
  if (pid_ < 0) return;
  kill(-pid_, SIGKILL);
  reap(true);
}

bool WorkerProcess::send(const Bytes& message) const {
  ssize_t sent;
  do {
    sent = ::send(channel_.get(), message.data(), message.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  } while (sent < 0 && errno == EINTR);
  return sent == static_cast<ssize_t>(message.size());
}

WorkerProcess::Received WorkerProcess::receive() {
  bool some = false;
  for (int blocks = 0; blocks < kMostBlocks; ++blocks) {
    const std::size_t before = arrived_.size();
    arrived_.resize(before + kReceiveBlock);
    const ssize_t n = recv(channel_.get(), arrived_.data() + before, kReceiveBlock, MSG_DONTWAIT);
    const int error = errno;
    arrived_.resize(before + static_cast<std::size_t>(n > 0 ? n : 0));
    if (n > 0) {
      some = true;
      continue;
    }
    if (n < 0 && error == EINTR) continue;
    if (n < 0 && (error == EAGAIN || error == EWOULDBLOCK)) {
      return some ? Received::kSome : Received::kNothing;
    }
    return some ? Received::kSome : Received::kEnd;  // the next call finds the end again
  }
  return Received::kSome;
}

std::optional<Message> WorkerProcess::next_message() {
  if (arrived_.size() < kLengthBytes) return std::nullopt;
  const std::span<const std::uint8_t> bytes(arrived_);
  const std::uint64_t length = announced_length(bytes.first<kLengthBytes>());
  if (length > longest_message_) {
    throw Error("a message announces " + std::to_string(length) + " bytes");
  }
  if (bytes.size() - kLengthBytes < length) return std::nullopt;
  Message message = decode(bytes.subspan(kLengthBytes, length));
  arrived_.erase(arrived_.begin(),
                 arrived_.begin() + static_cast<std::ptrdiff_t>(kLengthBytes + length));
  return message;
}

Failure WorkerProcess::end() {
  // The channel closes a moment before the process ends. Killing it at once would hide why it
  // ended.
  const auto deadline = std::chrono::steady_clock::now() + kEndGrace;
  std::optional<int> status = reap(false);
  while (!status && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    status = reap(false);
  }
  if (!status) return {FailureReason::kCrashed, "closed its channel"};
  if (!WIFSIGNALED(*status)) {
    return {FailureReason::kCrashed,
            "ended with exit code " + std::to_string(WEXITSTATUS(*status))};
  }
  const int signal = WTERMSIG(*status);
  if (signal == SIGKILL) {
    return {FailureReason::kOutOfMemory, "killed, most likely by the system for want of memory"};
  }
  return {FailureReason::kCrashed,
          "ended by signal " + std::to_string(signal) + " (" + strsignal(signal) + ")"};
}

std::optional<int> WorkerProcess::reap(bool wait) {
  int status = 0;
  pid_t reaped;
  do {
    reaped = waitpid(pid_, &status, wait ? 0 : WNOHANG);
  } while (reaped < 0 && errno == EINTR);
  if (reaped == 0) return std::nullopt;
  if (reaped == pid_) {
    kill(-pid_, SIGKILL);  // the processes that it may have started
    pid_ = -1;
  }
  return status;
}

}  // namespace emax
