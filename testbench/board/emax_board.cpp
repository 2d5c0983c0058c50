// A simulated ULX3S behind a pseudo-terminal, for `--device tty:PATH`.
#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "testbench/board/simulated_board.h"

namespace emax {
namespace {

constexpr const char* kUsage =
    "usage: emax_board [--link PATH]\n"
    "\n"
    "Simulates a ULX3S board with one element behind a pseudo-terminal, prints the terminal's "
    "path\n"
    "and serves until Ctrl-C. Hosts may come and go. It sleeps while nobody asks anything of it.\n"
    "\n"
    "  --link PATH   make PATH a symbolic link to the terminal; it is removed at the end;\n"
    "                a link that a killed emax_board left behind is replaced\n"
    "  --help        this text\n";

volatile std::sig_atomic_t stopped = 0;

[[noreturn]] void fail(const std::string& what) { throw Error(what + ": " + std::strerror(errno)); }

// A lock on the pseudo-terminal shows that a board serves it: the lock ends with the process that
// holds it, however the process ends. Hosts lock terminals with flock, which does not interfere.
struct flock whole_terminal() {
  struct flock lock = {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  return lock;
}

class Terminal {
 public:
  Terminal() {
    master_ = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0)
      fail("no pseudo-terminal can be opened");
    path_ = ptsname(master_);
    // Held open, so that the terminal stays when a host closes it.
    slave_ = open(path_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    termios settings;
    if (slave_ < 0 || tcgetattr(slave_, &settings) != 0) fail(path_ + " cannot be opened");
    cfmakeraw(&settings);
    struct flock lock = whole_terminal();
    if (tcsetattr(slave_, TCSANOW, &settings) != 0 || fcntl(slave_, F_SETLK, &lock) != 0 ||
        fcntl(master_, F_SETFL, O_NONBLOCK) != 0)
      fail(path_ + " cannot be set up");
  }
  ~Terminal() {
    close(slave_);
    close(master_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  const std::string& path() const { return path_; }

  // Sleeps until one of `events` or a signal comes, but at most a second: a signal that came just
  // before would otherwise be missed.
  void wait(short events) const {
    pollfd events_of_master = {master_, events, 0};
    poll(&events_of_master, 1, 1000);
  }

  // Ends a host's exclusive use of the terminal, as that host may be gone. The terminal is held
  // open here, so the system does not end it.
  void release() const { ioctl(slave_, TIOCNXCL); }

  std::size_t read(std::span<std::uint8_t> bytes) const {
    return count(::read(master_, bytes.data(), bytes.size()));
  }
  std::size_t write(std::span<const std::uint8_t> bytes) const {
    return count(::write(master_, bytes.data(), bytes.size()));
  }

 private:
  static std::size_t count(ssize_t result) {
    if (result >= 0) return static_cast<std::size_t>(result);
    if (errno == EAGAIN || errno == EINTR) return 0;
    fail("the pseudo-terminal is lost");
  }

  int master_ = -1, slave_ = -1;
  std::string path_;
};

// The target of a symbolic link; empty where there is no link.
std::string target_of(const std::string& link) {
  std::array<char, 4096> text;
  const ssize_t length = readlink(link.c_str(), text.data(), text.size());
  return length < 0 ? "" : std::string(text.data(), static_cast<std::size_t>(length));
}

// Which process serves the terminal, in words. Empty where none does: the terminal is gone, or its
// number belongs to another program's terminal by now.
std::string server_of(const std::string& terminal) {
  const int descriptor = open(terminal.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) {
    // A host uses the terminal exclusively, or it belongs to another user.
    return errno == EBUSY || errno == EACCES || errno == EPERM ? "another process" : "";
  }
  struct flock lock = whole_terminal();
  const bool known = fcntl(descriptor, F_GETLK, &lock) == 0;
  close(descriptor);
  if (!known || lock.l_type == F_UNLCK) return "";
  return "the emax_board of process " + std::to_string(lock.l_pid);
}

// The symbolic link to the terminal, removed at the end. Replaces a link that a killed board left.
class SymbolicLink {
 public:
  SymbolicLink(const std::string& target, const std::string& path) : target_(target) {
    if (path.empty()) return;
    if (symlink(target.c_str(), path.c_str()) != 0) {
      if (errno != EEXIST) fail(path + " cannot be made");
      remove_if_left_behind(path);
      if (symlink(target.c_str(), path.c_str()) != 0) fail(path + " cannot be made");
    }
    path_ = path;
  }
  ~SymbolicLink() {
    if (!path_.empty() && target_of(path_) == target_) unlink(path_.c_str());
  }
  SymbolicLink(const SymbolicLink&) = delete;
  SymbolicLink& operator=(const SymbolicLink&) = delete;

 private:
  void remove_if_left_behind(const std::string& path) const {
    const std::string before = target_of(path);
    if (!before.starts_with("/dev/pts/")) {
      throw Error(path + " cannot be made: " +
                  (before.empty() ? "it is there and is no link"
                                  : "it is a link to " + before + ", which is no pseudo-terminal") +
                  "; name another path");
    }
    // The link may name this board's own terminal, whose number the killed board had. It is not
    // opened again then, because the close would end this board's lock.
    const std::string server = before == target_ ? "" : server_of(before);
    if (!server.empty()) {
      throw Error(path + " leads to " + before + ", which " + server +
                  " serves; stop it or name another path");
    }
    unlink(path.c_str());
  }

  std::string target_, path_;
};

// Moves bytes between terminal and board until a signal comes.
void serve(const Terminal& terminal, SimulatedBoard& board) {
  std::array<std::uint8_t, 4096> buffer;
  std::vector<std::uint8_t> to_board, to_host;
  while (!stopped) {
    if (to_board.empty()) {
      const std::size_t count = terminal.read(buffer);
      to_board.assign(buffer.begin(), buffer.begin() + count);
    }
    const std::size_t taken = board.write(to_board);
    to_board.erase(to_board.begin(), to_board.begin() + static_cast<std::ptrdiff_t>(taken));
    if (to_host.empty()) {
      const std::size_t count = board.read(buffer, std::chrono::microseconds(20));
      to_host.assign(buffer.begin(), buffer.begin() + count);
    }
    const std::size_t given = terminal.write(to_host);
    to_host.erase(to_host.begin(), to_host.begin() + static_cast<std::ptrdiff_t>(given));
    // The board's time stops while the host does not read, and while the board has no work.
    if (!to_host.empty()) {
      terminal.wait(POLLOUT);
    } else if (board.settled() && to_board.empty()) {
      terminal.release();
      terminal.wait(POLLIN);
    }
  }
}

int run(const std::string& link) {
  struct sigaction action = {};
  action.sa_handler = [](int) { stopped = 1; };
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
  const Terminal terminal;
  const SymbolicLink symbolic_link(terminal.path(), link);
  SimulatedBoard board;
  const std::string path = link.empty() ? terminal.path() : link;
  std::printf("a simulated board is at %s; try: emax error CLOUD MESH --device tty:%s\n",
              path.c_str(), path.c_str());
  std::fflush(stdout);
  serve(terminal, board);
  return 0;
}

}  // namespace
}  // namespace emax

int main(int argc, char** argv) {
  std::string link;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--help" || option == "-h") {
      std::fputs(emax::kUsage, stdout);
      return 0;
    }
    if (option != "--link" || ++i == argc) {
      std::fputs(emax::kUsage, stderr);
      return 2;
    }
    link = argv[i];
  }
  try {
    return emax::run(link);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "emax_board: %s\n", error.what());
    return 1;
  }
}
