// Replays the folder of a failure on the element with probes and waveforms: names the sample and
// the first diverging node of the graph.
//
//   emax_cosim_replay FOLDER [--mutant N] [--window CYCLES] [--write]
//
// --mutant overrides the mutant of the folder (0: the unchanged design). --write writes report.txt,
// waveform.fst and waveform.gtkw to the folder. The waveform begins --window cycles before the
// mismatch (default 300) and holds the failing node.
// Exit code 0 without a mismatch, 1 on a mismatch, 2 when it cannot run.
#include <verilated_fst_c.h>
#include <verilated_syms.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>

#include <Vemax_element_probed.h>
#include <Vemax_element_probed___024root.h>
#include <Vemax_element_probed_device.h>
#include <Vemax_element_probed_device___024root.h>
#include <Vemax_element_probed_device_emax_mutation.h>
#include <Vemax_element_probed_emax_mutation.h>

#include "hls/lowering/designs.h"
#include "sw_model/base/error.h"
#include "testbench/cosimulation/failure_folder.h"
#include "testbench/diagnosis/diagnosis.h"
#include "testbench/diagnosis/save_file.h"
#include "testbench/element/verilated_element.h"

namespace emax {
namespace {

struct Window {
  std::uint64_t from = 1, to = 0;  // cycles of the run
};

// An element with probes that also writes a waveform of a window.
class TracedElement : public ProbedElement {
 public:
  virtual void open_waveform(const std::string& path) = 0;
  virtual void record(bool on) = 0;
  virtual std::uint64_t time() const = 0;  // of the waveform
  // To be called before a failure is raised too: a trace that was not closed cannot be read.
  virtual void close_waveform() = 0;
};

// The ports of the datapath, which probes.vlt makes readable by name, in the order of the graph's
// inputs.
class DatapathInputs {
 public:
  explicit DatapathInputs(const VerilatedContext& context) {
    const VerilatedScope* scope = context.scopeFind("TOP.emax_element.distance.datapath");
    if (scope == nullptr) throw std::logic_error("the datapath's scope is not readable");
    for (const Input& input : emax_distance_design().graph.inputs()) {
      const VerilatedVar* port = scope->varFind(input.name.c_str());
      if (port == nullptr) throw std::logic_error(input.name + " is missing in probes.vlt");
      ports_.push_back(port);
    }
  }

  Word word(std::size_t i) const {
    const void* data = ports_[i]->datap();
    return ports_[i]->vltype() == VLVT_UINT8 ? Word{*static_cast<const CData*>(data)}
                                             : Word{*static_cast<const IData*>(data)};
  }

 private:
  std::vector<const VerilatedVar*> ports_;
};

template <class Model, std::uint32_t kSlotBits>
class Traced : public VerilatedElement<Model, kSlotBits>, public TracedElement {
 public:
  Traced()
      : VerilatedElement<Model, kSlotBits>([](Model& model, std::uint32_t mutant) {
          model.rootp->__PVT__emax_mutation->active = static_cast<IData>(mutant);
        }),
        inputs_(this->context()) {}

  Word probe(std::size_t i) const override {
    return this->model().rootp->emax_element__DOT__distance__DOT__datapath__DOT__probes[i];
  }
  Word input(std::size_t i) const override { return inputs_.word(i); }
  std::uint64_t time() const override { return this->context().time(); }
  void open_waveform(const std::string& path) override {
    this->context().traceEverOn(true);
    this->model().trace(&trace_, 99);
    trace_.open(path.c_str());
  }
  void record(bool on) override { recording_ = on; }
  void close_waveform() override { trace_.close(); }

 protected:
  void after_edge(std::uint64_t time) override {
    if (recording_) trace_.dump(time);
  }

 private:
  VerilatedFstC trace_;
  bool recording_ = false;
  const DatapathInputs inputs_;
};

std::unique_ptr<TracedElement> make_traced(std::uint32_t slot_bits) {
  if (slot_bits == kDeviceSlotBits) {
    return std::make_unique<Traced<Vemax_element_probed_device, kDeviceSlotBits>>();
  }
  if (slot_bits == kPairsSlotBits) {
    return std::make_unique<Traced<Vemax_element_probed, kPairsSlotBits>>();
  }
  throw Error("no element with " + std::to_string(slot_bits) + " slot bits; input.txt says so");
}

class WindowObserver : public RunObserver {
 public:
  // mark() gives the waveform's time of the cycle `marked`.
  WindowObserver(TracedElement& element, const Window& window, std::uint64_t marked)
      : element_(element), window_(window), marked_(marked) {}
  void pair_accepted(std::size_t, std::uint64_t) override {}
  void cycle_ended(std::uint64_t cycle) override {
    element_.record(cycle + 1 >= window_.from && cycle + 1 <= window_.to);
    // The cycle began two half cycles ago.
    if (cycle + 1 == marked_) mark_ = element_.time() - 2;
  }
  std::uint64_t mark() const { return mark_; }

 private:
  TracedElement& element_;
  Window window_;
  std::uint64_t marked_, mark_ = 0;
};

struct Options {
  std::string folder;
  std::optional<std::uint32_t> mutant;
  std::uint64_t window = 300;
  bool write = false;
};

void write_file(const std::string& path, const std::string& text) {
  std::ofstream out(path);
  out << text;
  out.close();
  if (!out) throw Error(path + ": cannot be written");
}

void write_findings(const Options& options, const Failure& failure,
                    const std::optional<NodeMismatch>& divergence, const std::string& report) {
  const std::string folder = std::filesystem::absolute(options.folder).string();
  const std::uint64_t end = failure.mismatch.cycle;
  const std::uint64_t marked = divergence ? divergence->cycle : end;
  std::uint64_t begin = end > options.window ? end - options.window : 0;
  if (divergence) begin = std::min(begin, divergence->start);
  const auto traced = make_traced(failure.slot_bits);
  traced->set_mutant(failure.mutant);
  traced->open_waveform(folder + "/waveform.fst");
  WindowObserver observer(*traced, {begin, end + 1}, marked);
  run_sequence(failure.runs, *traced, &observer);
  traced->close_waveform();
  write_file(folder + "/report.txt", report);
  write_file(folder + "/waveform.gtkw",
             save_file(signal_groups(divergence), folder + "/waveform.fst", observer.mark()));
}

int replay(const Options& options) {
  Failure failure = read_failure(options.folder);
  if (options.mutant) failure.mutant = *options.mutant;
  const auto element = make_traced(failure.slot_bits);
  element->set_mutant(failure.mutant);
  NodeObserver nodes(*element);
  const RunResult result = run_sequence(failure.runs, *element, &nodes);
  if (!result.mismatch) {
    std::printf("replay: test '%s', seed %llu: %llu pairs, 0 mismatches\n", failure.test.c_str(),
                static_cast<unsigned long long>(failure.seed),
                static_cast<unsigned long long>(result.pairs));
    return 0;
  }
  failure.mismatch = *result.mismatch;
  std::string report = describe(failure);
  const ElementRun& run = failure.runs.back();
  auto divergence = nodes.first_divergence(run, result.mismatch->pair);
  if (!divergence) divergence = nodes.first_divergence(run, {});
  const std::optional<std::size_t> pair = divergence ? divergence->pair : result.mismatch->pair;
  if (pair) report += describe_pair(run, *pair);
  report += divergence ? describe(*divergence)
                       : "every node of the graph agrees with the model: the fault lies behind or "
                         "beside the datapath\n";
  std::fputs(report.c_str(), stdout);
  if (options.write) write_findings(options, failure, divergence, report);
  return 1;
}

bool parse(int argc, char** argv, Options& options) {
  const auto number = [](const char* text, auto& value) {
    char* end = nullptr;
    value = static_cast<std::uint32_t>(std::strtoul(text, &end, 10));
    return end != text && *end == '\0';
  };
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--write") {
      options.write = true;
    } else if (argument == "--mutant" && i + 1 < argc) {
      if (!number(argv[++i], options.mutant)) return false;
    } else if (argument == "--window" && i + 1 < argc) {
      if (!number(argv[++i], options.window)) return false;
    } else if (options.folder.empty() && !argument.starts_with('-')) {
      options.folder = argument;
    } else {
      return false;
    }
  }
  return !options.folder.empty();
}

}  // namespace
}  // namespace emax

int main(int argc, char** argv) {
  emax::Options options;
  if (!emax::parse(argc, argv, options)) {
    std::fprintf(stderr,
                 "usage: emax_cosim_replay FOLDER [--mutant N] [--window CYCLES] [--write]\n");
    return 2;
  }
  try {
    return emax::replay(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "emax_cosim_replay: %s\n", error.what());
    return 2;
  }
}
