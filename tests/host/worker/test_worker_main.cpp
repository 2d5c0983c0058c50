#include "host/worker/worker.h"
#include "host/worker_pool/worker_process.h"
#include "tests/host/worker/test_methods.h"

int main(int argc, char** argv) {
  return emax::run_worker(std::span(argv, static_cast<std::size_t>(argc)),
                          [](const emax::ChainSettings& settings) {
                            emax::test::run_test_method(settings, emax::kChannelFd);
                          });
}
