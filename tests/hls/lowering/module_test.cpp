// The text of generated modules: names, drivers, and what Verilator says of it.
#include <gtest/gtest.h>
#include <stdio.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "hls/lowering/identifiers.h"
#include "hls/lowering/systemverilog.h"
#include "tests/hls/lowering/module_text.h"
#include "tests/hls/lowering/random_graph.h"

namespace emax {
namespace {

namespace fs = std::filesystem;

struct Finished {
  int status;
  std::string output;
};

Finished run_command(const std::string& command) {
  Finished finished{-1, ""};
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return finished;
  std::array<char, 4096> buffer;
  while (const std::size_t count = fread(buffer.data(), 1, buffer.size(), pipe)) {
    finished.output.append(buffer.data(), count);
  }
  finished.status = pclose(pipe);
  return finished;
}

Finished lint(const std::string& arguments) {
  const std::string root = EMAX_PROJECT;
  return run_command(std::string(EMAX_VERILATOR) + " --lint-only -Wall -I" + root + "/hls/rtl -I" +
                     root + "/hls/rtl/behavioural -I" + root + "/hls/rtl/division -I" + root +
                     "/hls/rtl/fixed " + arguments);
}

// Verilator's verdict on a module of the given name in a file of its own; empty if it is sound.
// Random graphs leave bits of their values unused.
std::string lint_verdict(const std::string& name, const std::string& text) {
  const fs::path folder = fs::temp_directory_path() / ("emax_module_test_" + name);
  fs::create_directories(folder);
  const fs::path file = folder / (name + ".sv");
  std::ofstream(file) << text;
  const Finished finished = lint("-Wno-UNUSEDSIGNAL --top-module " + name + " " + file.string());
  fs::remove_all(folder);
  if (finished.status == 0) return "";
  return finished.output.empty() ? "it did not run" : finished.output;
}

bool has_clock(const std::string& text) { return text.find(" clk,") != std::string::npos; }

TEST(Module, HasOneDriverASignalAndLegalUniqueNames) {
  int units = 0, early_outputs = 0;
  for (std::uint64_t seed = 1; seed <= 600; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const LoweredDesign design = test::adversarial_design(random, 4 + random.below(40));
    const std::string text = datapath_module(design);
    ASSERT_EQ(test::fault_of_module(text), "") << text;
    for (const Output& output : design.graph.outputs()) {
      early_outputs += design.graph.is_operation(output.node) &&
                       design.schedule.ready[output.node] < design.schedule.latency;
    }
    if (!has_clock(text)) continue;
    const std::string unit = unit_module(design);
    ASSERT_EQ(test::fault_of_module(unit), "") << unit;
    ++units;
  }
  EXPECT_GT(units, 300);
  EXPECT_GT(early_outputs, 300);
}

TEST(Module, OfEveryFormHasOneDriverASignalAndLegalUniqueNames) {
  for (const Form form : kForms) {
    const LoweredDesign design = lower(form, {});
    EXPECT_EQ(test::fault_of_module(datapath_module(design)), "");
    if (info(form).record_bits > 0) {
      EXPECT_EQ(test::fault_of_module(unit_module(design)), "");
    }
  }
}

// The text with the first `before` changed; the test fails where there is none.
std::string changed(std::string text, const std::string& before, const std::string& after) {
  const std::size_t at = text.find(before);
  EXPECT_NE(at, std::string::npos) << before;
  return at == std::string::npos ? text : text.replace(at, before.size(), after);
}

TEST(Module, CheckSeesEachKindOfFault) {
  const std::string text = datapath_module(test::several_outputs_design());
  ASSERT_EQ(test::fault_of_module(text), "");
  const auto fault = [&](const std::string& before, const std::string& after) {
    return test::fault_of_module(changed(text, before, after));
  };
  EXPECT_EQ(fault("  assign early = ", "  assign early = d;\n  assign early = "),
            "early has 2 drivers");
  EXPECT_EQ(fault("  assign early = ", "  assign early_again = "), "early has 0 drivers");
  EXPECT_EQ(fault(".sum(d)", ".sum(d_adder)"), "d has 0 drivers");
  EXPECT_EQ(fault(" d, d_at_35", " dist_value, d_at_35"), "dist_value is declared twice");
  EXPECT_EQ(fault("d_adder_2 (", "d_adder ("), "d_adder is declared twice");
  EXPECT_EQ(fault("ONE_2 = ", "ONE = "), "ONE is declared twice");
  EXPECT_EQ(fault("module several_outputs", "module d"), "d is declared twice");
  EXPECT_EQ(fault(" dist_value,", " dist,"), "dist is a keyword");
  EXPECT_EQ(fault(".a(dist_value_at_1)", ".a(nothing)"), "nothing is used but not declared");
  EXPECT_EQ(fault("  assign through = ", "  assign dist_value = d;\n  assign through = "),
            "dist_value is driven but is no signal");
}

TEST(Module, IsSoundToVerilator) {
  int seen = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const LoweredDesign design = test::adversarial_design(random, 20);
    EXPECT_EQ(lint_verdict("adversarial", datapath_module(design)), "");
    ++seen;
  }
  EXPECT_EQ(seen, 12);
}

TEST(Module, FaultsAreSeenByVerilator) {
  const std::string text = datapath_module(test::several_outputs_design());
  ASSERT_EQ(lint_verdict("several_outputs", text), "");
  const std::string port = lint_verdict("several_outputs", changed(text, " dist_value,", " dist,"));
  EXPECT_NE(port.find("syntax error"), std::string::npos) << port;
  const std::string twice =
      lint_verdict("several_outputs", changed(text, "d_adder_2 (", "d_adder ("));
  EXPECT_NE(twice.find("Unsupported in C"), std::string::npos) << twice;
}

TEST(Module, OfSeveralOutputsIsTheOneCheckedIn) {
  const fs::path file = fs::path(EMAX_PROJECT) / "tests/hls/lowering/several_outputs.sv";
  std::ifstream in(file);
  std::ostringstream content;
  content << in.rdbuf();
  const std::string text = datapath_module(test::several_outputs_design());
  if (content.str() == text) return;
  const fs::path now = fs::temp_directory_path() / "several_outputs.sv";
  std::ofstream(now) << text;
  ADD_FAILURE() << file << " differs: copy " << now << " over it";
}

// The limits of the command line are those of the modules' own checks: each takes the bounds and
// refuses what is one beyond.
TEST(Module, LatencyLimitsAreThoseOfTheOperators) {
  int operators = 0;
  for (const LatencyLimits& limits : kLatencyLimits) {
    if (limits.module.empty()) continue;
    ++operators;
    for (const int cycles : {limits.least - 1, limits.least, limits.most, limits.most + 1}) {
      const std::string module(limits.module);
      std::string file;
      for (const char* folder : {"", "division/", "fixed/"}) {
        const std::string path = EMAX_PROJECT "/hls/rtl/" + (folder + module) + ".sv";
        if (fs::exists(path)) file = path;
      }
      const Finished finished =
          lint("-GLATENCY=" + std::to_string(cycles) + " --top-module " + module + " " + file);
      const bool permitted = cycles >= limits.least && cycles <= limits.most;
      EXPECT_EQ(finished.status == 0, permitted) << module << ' ' << cycles << finished.output;
      const std::string refusal = module + ": LATENCY must be " + std::to_string(limits.least) +
                                  " to " + std::to_string(limits.most);
      EXPECT_EQ(finished.output.find(refusal) == std::string::npos, permitted)
          << module << ' ' << cycles << finished.output;
    }
  }
  EXPECT_EQ(operators, 11);
}

}  // namespace
}  // namespace emax
