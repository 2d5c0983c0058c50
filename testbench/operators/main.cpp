// Drives the Verilated operators beside the processor's own binary32 and, with all pairs of two
// formats of 8 bits, beside an exact reference. Exit code 0 when all results agree.

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "sw_model/error.h"
#include "testbench/operators/operator_cosim.h"
#include "testbench/operators/operator_unit.h"

namespace emax {
namespace {

constexpr const char* kUsage =
    "usage: emax_operator_cosim [--operator NAME|all] [--pairs N] [--seed N] [--full] [--fault]\n"
    "         [--coverage FILE]\n"
    "  --operator   add, subtract, multiply, square, less, negative, positive or all (the "
    "default)\n"
    "  --pairs      random pairs beside the corner pairs (default 4000000; --full 100000000)\n"
    "  --fault      changes one bit of one result, which must be found\n"
    "  --coverage   writes what the RTL counted (emax_operator_coverage only)\n";

struct Options {
  std::optional<Operator> only;
  std::uint64_t pairs = 4'000'000;
  std::uint64_t seed = 1;
  bool fault = false;
  std::string coverage;
};

// Any unit with one bit of one result changed.
class FaultyUnit : public OperatorUnit {
 public:
  FaultyUnit(std::unique_ptr<OperatorUnit> unit, Operator op) : unit_(std::move(unit)), op_(op) {}
  void run(std::span<const OperandPair> pairs, std::span<OperatorResults> results) override {
    unit_->run(pairs, results);
    if (!done_) results[pairs.size() / 2].word[static_cast<std::size_t>(op_)] ^= 1u;
    done_ = true;
  }
  void write_coverage(const std::string& path) override { unit_->write_coverage(path); }

 private:
  std::unique_ptr<OperatorUnit> unit_;
  Operator op_;
  bool done_ = false;
};

// Prints one line an operator; returns the mismatches.
std::uint64_t print(const char* format, const OperatorRun& run, const Options& options) {
  std::uint64_t mismatches = 0;
  for (int o = 0; o < kOperators; ++o) {
    const auto op = static_cast<Operator>(o);
    const OperatorResult& result = run[static_cast<std::size_t>(o)];
    if (options.only && *options.only != op) continue;
    std::printf("%-9s %-9s %12llu pairs %10llu mismatches\n", operator_name(op), format,
                static_cast<unsigned long long>(result.pairs),
                static_cast<unsigned long long>(result.mismatches));
    if (!result.first_mismatch.empty()) {
      std::printf("first mismatch, seed %llu: %s\n", static_cast<unsigned long long>(options.seed),
                  result.first_mismatch.c_str());
    }
    mismatches += result.mismatches;
  }
  return mismatches;
}

int run(const Options& options) {
#ifdef EMAX_OPERATOR_COVERAGE
  std::unique_ptr<OperatorUnit> unit = make_covered_operators();
#else
  std::unique_ptr<OperatorUnit> unit = make_operators_8_23();
#endif
  OperatorUnit& rtl = *unit;
  if (options.fault) {
    unit = std::make_unique<FaultyUnit>(std::move(unit), options.only.value_or(Operator::kAdd));
  }
  const auto start = std::chrono::steady_clock::now();
  const OperatorRun wide = run_operator_cosim(*unit, options.pairs, options.seed);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  std::uint64_t mismatches = print("binary32", wide, options);
  std::uint64_t pairs = wide[0].pairs;
#ifndef EMAX_OPERATOR_COVERAGE
  const OperatorRun narrow = run_small_cosim(*make_operators_4_3(), {4, 3});
  const OperatorRun narrower = run_small_cosim(*make_operators_5_2(), {5, 2});
  mismatches += print("4+3 bits", narrow, options) + print("5+2 bits", narrower, options);
  pairs += narrow[0].pairs + narrower[0].pairs;
#endif
  std::printf("%.2f million pairs/s of binary32 through all operators\n",
              static_cast<double>(wide[0].pairs) / time.count() * 1e-6);
  std::printf("operators: seed %llu, %llu pairs, %llu mismatches\n",
              static_cast<unsigned long long>(options.seed), static_cast<unsigned long long>(pairs),
              static_cast<unsigned long long>(mismatches));
  if (!options.coverage.empty()) rtl.write_coverage(options.coverage);
  return mismatches == 0 ? 0 : 1;
}

bool parse(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--fault") {
      options.fault = true;
      continue;
    }
    if (argument == "--full") {
      options.pairs = 100'000'000;
      continue;
    }
    if (++i == argc) return false;
    const std::string value = argv[i];
    char* end = nullptr;
    if (argument == "--pairs" || argument == "--seed") {
      (argument == "--pairs" ? options.pairs : options.seed) = std::strtoull(argv[i], &end, 10);
      if (value.empty() || *end != '\0') return false;
    } else if (argument == "--operator") {
      options.only = operator_of_name(value);
      if (!options.only && value != "all") return false;
    } else if (argument == "--coverage") {
      options.coverage = value;
    } else {
      return false;
    }
  }
  return true;
}

}  // namespace
}  // namespace emax

int main(int argc, char** argv) {
  emax::Options options;
  if (!emax::parse(argc, argv, options)) {
    std::fputs(emax::kUsage, stderr);
    return 2;
  }
  try {
    return emax::run(options);
  } catch (const emax::Error& error) {
    std::fprintf(stderr, "emax_operator_cosim: %s\n", error.what());
    return 1;
  }
}
