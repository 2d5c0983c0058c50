#include "host/worker_pool/worker_process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <csignal>

#include <chrono>
#include <thread>

#include "sw_model/base/error.h"
#include "tests/host/support/surface_clouds.h"

namespace emax::test {
namespace {

using namespace std::chrono_literals;

WorkerProcess::Command command() { return {EMAX_TEST_WORKER, 0}; }

FileDescriptor points() { return sealed_file(encode(PointsMessage{sphere_cloud(50), {}})); }

Message next_message(WorkerProcess& worker) {
  while (true) {
    if (auto message = worker.next_message()) return *message;
    pollfd channel{worker.channel(), POLLIN, 0};
    poll(&channel, 1, 60'000);
    if (worker.receive() == WorkerProcess::Received::kEnd) throw Error("the worker ended");
  }
}

RunMessage run(const std::string& method) { return {1, {method, "schroeder", {}}}; }

TEST(WorkerProcess, LivesInItsOwnProcessGroup) {
  WorkerProcess worker(command(), points());
  EXPECT_EQ(getpgid(worker.pid()), worker.pid());
  EXPECT_NE(getpgid(worker.pid()), getpgrp());
}

TEST(WorkerProcess, IsGoneWithItsOwner) {
  pid_t pid;
  {
    WorkerProcess worker(command(), points());
    std::get<ReadyMessage>(next_message(worker));
    pid = worker.pid();
  }
  EXPECT_EQ(kill(pid, 0), -1);
  EXPECT_EQ(errno, ESRCH);
}

// The program is killed while its worker is busy: the worker notices by itself.
TEST(WorkerProcess, EndsWhenTheProgramThatSpawnedItIsKilled) {
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  int report[2];
  ASSERT_EQ(pipe(report), 0);
  const pid_t program = fork();
  if (program == 0) {
    WorkerProcess worker(command(), points());
    next_message(worker);
    worker.send(encode(run("test.hang")));
    const pid_t pid = worker.pid();
    if (write(report[1], &pid, sizeof pid) != sizeof pid) _exit(1);
    while (true) pause();
  }
  close(report[1]);
  pid_t worker = 0;
  ASSERT_EQ(read(report[0], &worker, sizeof worker), static_cast<ssize_t>(sizeof worker));
  close(report[0]);
  EXPECT_EQ(kill(worker, 0), 0);
  kill(program, SIGKILL);
  waitpid(program, nullptr, 0);
  pid_t reaped = 0;
  for (int i = 0; i < 1000 && reaped == 0; ++i) {
    reaped = waitpid(worker, nullptr, WNOHANG);
    std::this_thread::sleep_for(10ms);
  }
  EXPECT_EQ(reaped, worker);
}

TEST(WorkerProcess, KeepsWhatLibrariesPrintOutOfTheChannel) {
  WorkerProcess worker(command(), points());
  next_message(worker);
  worker.send(encode(run("test.print")));
  EXPECT_EQ(std::get<FailureMessage>(next_message(worker)).failure.message, "printed");
}

// A service manager signals all processes at once: the evaluation in work is no failure of its own.
TEST(WorkerProcess, EndsWithItsProgramAndNotBySignals) {
  WorkerProcess worker(command(), points());
  std::get<ReadyMessage>(next_message(worker));
  for (const int signal : {SIGHUP, SIGINT, SIGTERM}) kill(worker.pid(), signal);
  worker.send(encode(run("test.error")));
  EXPECT_EQ(std::get<FailureMessage>(next_message(worker)).failure.reason, FailureReason::kError);
}

TEST(WorkerProcess, OfTheProductKnowsNoTestMethods) {
  WorkerProcess::Command product = command();
  product.program = product.program.parent_path() / "emax_worker";
  WorkerProcess worker(product, points());
  next_message(worker);
  worker.send(encode(run("test.crash")));
  const auto answer = std::get<FailureMessage>(next_message(worker));
  EXPECT_NE(answer.failure.message.find("no reconstruction method"), std::string::npos);
}

TEST(WorkerProcess, ThatCannotStartIsNamed) {
  WorkerProcess::Command missing = command();
  missing.program = "/nonexistent/emax_worker";
  try {
    WorkerProcess worker(missing, points());
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("/nonexistent/emax_worker"), std::string::npos);
  }
}

TEST(SealedFile, CannotBeChanged) {
  const Bytes bytes = {1, 2, 3};
  const FileDescriptor file = sealed_file(bytes);
  EXPECT_EQ(pwrite(file.get(), bytes.data(), 1, 0), -1);
  EXPECT_EQ(ftruncate(file.get(), 0), -1);
}

}  // namespace
}  // namespace emax::test
