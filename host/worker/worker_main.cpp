#include "host/worker/worker.h"

int main(int argc, char** argv) {
  return emax::run_worker(std::span(argv, static_cast<std::size_t>(argc)));
}
