#include "host/worker/worker.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <string_view>
#include <thread>

#include "host/chain/chain.h"
#include "host/reconstruct/part_surface.h"
#include "host/worker_pool/message.h"
#include "host/worker_pool/worker_process.h"
#include "sw_model/base/error.h"
#include "sw_model/model/self_test.h"

namespace emax {
namespace {

// Leaves without destroying the static objects of libraries: PCL's Poisson crashes when they are
// destroyed.
[[noreturn]] void leave(int code) { _exit(code); }

// Leaves as soon as the program that started the worker has ended, even while a library calculates:
// nobody waits for the answer.
void leave_on_hangup() {
  std::thread([] {
    pollfd channel{kChannelFd, 0, 0};
    while (poll(&channel, 1, -1) < 0 && errno == EINTR) {
    }
    leave(0);
  }).detach();
}

// Bytes of address space that an evaluation may take; 0 for any. A thread reserves some for its
// stack and its heap, which is not the evaluation's.
void limit_memory(std::uint64_t bytes, std::uint64_t threads) {
  constexpr std::uint64_t kOfAThread = std::uint64_t{192} << 20;
  if (bytes == 0) return;
  rlimit value{};
  getrlimit(RLIMIT_AS, &value);
  value.rlim_cur = bytes + (threads - 1) * kOfAThread;
  setrlimit(RLIMIT_AS, &value);
}

void send(const Bytes& bytes) {
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t n = write(kChannelFd, bytes.data() + sent, bytes.size() - sent);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) leave(1);
    sent += static_cast<std::size_t>(n);
  }
}

// Leaves when the stream ends before `bytes` is full.
void read_fully(int fd, std::span<std::uint8_t> bytes) {
  for (std::size_t got = 0; got < bytes.size();) {
    const ssize_t n = read(fd, bytes.data() + got, bytes.size() - got);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) leave(n < 0);
    got += static_cast<std::size_t>(n);
  }
}

Message receive() {
  std::array<std::uint8_t, kLengthBytes> length;
  read_fully(kChannelFd, length);
  Bytes body(announced_length(length));
  read_fully(kChannelFd, body);
  return decode(body);
}

// The file and its position are shared with other workers, so it is read by offset.
Message first_message() {
  struct stat status;
  if (fstat(kPointsFd, &status) != 0) throw Error(std::string("no request: ") + strerror(errno));
  Bytes bytes(static_cast<std::size_t>(status.st_size));
  for (std::size_t got = 0; got < bytes.size();) {
    const ssize_t n =
        pread(kPointsFd, bytes.data() + got, bytes.size() - got, static_cast<off_t>(got));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) throw Error("the request is cut short");
    got += static_cast<std::size_t>(n);
  }
  return decode(std::span(bytes).subspan(kLengthBytes));
}

// Whether the program asks for the mesh reached so far. No other message can arrive during a run.
bool asked_to_stop() {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kBetween{5};
  static Clock::time_point next;
  const Clock::time_point now = Clock::now();
  if (now < next) return false;
  pollfd channel{kChannelFd, POLLIN, 0};
  if (poll(&channel, 1, 0) > 0) return true;
  next = now + kBetween;
  return false;
}

// Waits for the next run. A stop message that arrives here came after the answer and is ignored.
RunMessage next_run() {
  while (true) {
    Message message = receive();
    if (!std::holds_alternative<StopMessage>(message))
      return std::get<RunMessage>(std::move(message));
  }
}

// Returns the answer's bytes. Making them also takes memory, so they are made here.
Bytes evaluate(Chain& chain, const RunMessage& run, const BeforeRun& before) {
  try {
    if (before) before(run.settings);
    return encode(
        MeshMessage{run.ticket, chain.run(run.settings, {asked_to_stop, run.rival, run.threads})});
  } catch (const std::bad_alloc&) {
    return encode(FailureMessage{run.ticket, {FailureReason::kOutOfMemory, "needs more memory"}});
  } catch (const std::exception& e) {
    return encode(FailureMessage{run.ticket, {FailureReason::kError, e.what()}});
  }
}

// If memory runs out between evaluations, the worker leaves. That costs one evaluation, as a crash
// does.
[[noreturn]] void answer_requests(Chain& chain, std::uint64_t memory_limit,
                                  const BeforeRun& before) {
  try {
    for (bool first = true;; first = false) {
      const RunMessage run = next_run();
      limit_memory(memory_limit, run.threads);
      const Bytes answer = evaluate(chain, run, before);
      // A library may have changed the rounding or flush mode when it was first used.
      if (first) verify_arithmetic();
      send(answer);
    }
  } catch (const std::bad_alloc&) {
    leave(1);
  }
}

[[noreturn]] void serve(std::uint64_t memory_limit, const BeforeRun& before) {
  verify_arithmetic();
  Message message = first_message();
  if (const auto* part = std::get_if<PartMessage>(&message)) {
    run_part_step(part->folder, part_step_named(part->step), part->part);
    send(encode(ReadyMessage{}));
    leave(0);
  }
  PointsMessage given = std::get<PointsMessage>(std::move(message));
  Chain chain(std::move(given.points), std::move(given.bound));
  send(encode(ReadyMessage{}));
  answer_requests(chain, memory_limit, before);
}

}  // namespace

int run_worker(std::span<char*> arguments, const BeforeRun& before) {
  if (arguments.size() < 2 || fcntl(kChannelFd, F_GETFD) < 0 || fcntl(kPointsFd, F_GETFD) < 0) {
    std::fputs("emax_worker: emax starts this program itself; run emax instead\n", stderr);
    return 1;
  }
  const std::string_view memory = arguments[1];
  std::uint64_t memory_limit = 0;
  std::from_chars(memory.data(), memory.data() + memory.size(), memory_limit);
  limit_memory(memory_limit, 1);
  constexpr rlimit kNoCore{};
  setrlimit(RLIMIT_CORE, &kNoCore);
  // A signal that stops the program may also reach its workers. They ignore it and end when the
  // program ends: if they ended before, their evaluations would count as failed.
  for (const int signal_number : {SIGHUP, SIGINT, SIGTERM}) std::signal(signal_number, SIG_IGN);
  leave_on_hangup();
  try {
    serve(memory_limit, before);
  } catch (const std::bad_alloc&) {
    send(encode(UnusableMessage{"needs more memory; raise the memory limit"}));
  } catch (const std::exception& e) {
    send(encode(UnusableMessage{e.what()}));
  }
  leave(1);
}

}  // namespace emax
