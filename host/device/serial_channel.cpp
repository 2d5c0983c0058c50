#include "host/device/serial_channel.h"

// The kernel's termios2 takes any speed; <termios.h> takes only fixed ones and clashes with it.
#include <asm/termbits.h>
#include <fcntl.h>
#include <linux/serial.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <thread>

namespace emax {
namespace {

bool is_no_fault(int error) { return error == EAGAIN || error == EINTR; }

}  // namespace

std::string why_not_opened(int error) {
  switch (error) {
    case ENOENT:
    case ENXIO:
    case ENODEV:
      return "there is no such port; plug the board in and see `ls /dev/serial/by-id`";
    case EACCES:
    case EPERM:
      return "no permission; `sudo usermod -aG dialout $USER` and a new login give the right to "
             "USB serial ports";
    case EBUSY:
    case EWOULDBLOCK:
      return "another process uses the port; end it (`fuser` with the path names it)";
    default:
      return std::strerror(error);
  }
}

SerialChannel::SerialChannel(const std::string& path, std::uint32_t baud)
    : path_(path), baud_(baud) {
  open_port();
}

SerialChannel::~SerialChannel() {
  if (port_ >= 0) close(port_);
}

std::size_t SerialChannel::write(std::span<const std::uint8_t> bytes) {
  if (port_ < 0) lose();
  const ssize_t count = ::write(port_, bytes.data(), bytes.size());
  if (count >= 0) return static_cast<std::size_t>(count);
  if (!is_no_fault(errno)) lose();
  return 0;
}

std::size_t SerialChannel::read(std::span<std::uint8_t> bytes, std::chrono::microseconds wait) {
  if (port_ < 0) lose();
  pollfd waiting = {port_, POLLIN, 0};
  const timespec time = {wait.count() / 1000000, wait.count() % 1000000 * 1000};
  const int ready = ppoll(&waiting, 1, &time, nullptr);
  if (ready < 0 && !is_no_fault(errno)) lose();
  if (ready <= 0) return 0;
  const ssize_t count = ::read(port_, bytes.data(), bytes.size());
  if (count > 0) return static_cast<std::size_t>(count);
  if (count == 0 || !is_no_fault(errno)) lose();
  return 0;
}

std::chrono::steady_clock::duration SerialChannel::now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

bool SerialChannel::reopen() {
  try {
    open_port();
    return true;
  } catch (const Error&) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    return false;
  }
}

void SerialChannel::open_port() {
  port_ = open(path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (port_ < 0) refuse(why_not_opened(errno));
  // The lock excludes every process; TIOCEXCL alone would admit the superuser.
  if (flock(port_, LOCK_EX | LOCK_NB) < 0) refuse(why_not_opened(errno));
  set_up();
  ioctl(port_, TIOCEXCL);
}

void SerialChannel::set_up() {
  termios2 settings = {};
  if (ioctl(port_, TCGETS2, &settings) < 0) {
    refuse("this is not a serial port; name one such as /dev/ttyUSB0");
  }
  settings.c_iflag = settings.c_oflag = settings.c_lflag = 0;
  settings.c_cflag = CS8 | CREAD | CLOCAL | BOTHER | (BOTHER << IBSHIFT);
  settings.c_ispeed = settings.c_ospeed = baud_;
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
  const bool set = ioctl(port_, TCSETS2, &settings) == 0;
  // A receiver tolerates a difference of 2 % between the clocks of both sides.
  if (!set || ioctl(port_, TCGETS2, &settings) < 0 || settings.c_ospeed > baud_ + baud_ / 50 ||
      settings.c_ospeed < baud_ - baud_ / 50) {
    refuse("the port cannot run at " + std::to_string(baud_) + " baud; give one that it and the " +
           "board can after the path, as @115200");
  }
  // Otherwise USB adapters hold bytes back for 16 ms. A port without such a timer refuses the call.
  serial_struct serial = {};
  if (ioctl(port_, TIOCGSERIAL, &serial) == 0) {
    serial.flags |= ASYNC_LOW_LATENCY;
    ioctl(port_, TIOCSSERIAL, &serial);
  }
  ioctl(port_, TCFLSH, TCIOFLUSH);
}

void SerialChannel::refuse(const std::string& what) {
  if (port_ >= 0) close(port_);
  port_ = -1;
  throw Error("device " + name() + ": " + what);
}

void SerialChannel::lose() {
  if (port_ >= 0) close(port_);
  port_ = -1;
  throw ChannelLost("device " + name() + ": the port has gone; plug the board in and run again");
}

}  // namespace emax
