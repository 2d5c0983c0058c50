#include "host/app/interrupt.h"

#include <csignal>

namespace emax {
namespace {

volatile std::sig_atomic_t signalled = 0;

}  // namespace

void note_interrupts() {
  struct sigaction action = {};
  action.sa_handler = [](int) { signalled = 1; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool was_interrupted() { return signalled != 0; }

}  // namespace emax
