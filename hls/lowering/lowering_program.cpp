#include "hls/lowering/lowering_program.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "hls/lowering/graph_json.h"
#include "hls/lowering/identifiers.h"
#include "hls/lowering/opencl.h"
#include "hls/lowering/report.h"
#include "hls/lowering/systemverilog.h"
#include "hls/lowering/testbench_text.h"

namespace emax {
namespace {

constexpr std::string_view kHelp = R"(usage: PROGRAM NAME [OPTION...] [-o FILE]OTHER_USAGE

Lowers a function to a pipeline and writes it to FILE, or to standard output.
NAME is SUBJECTS.

what to write (the datapath unless one of these is given)
  --unit              the record memory beside the datapath, module NAME_unit
  --schedule          macros with the schedule's figures, for the modules that use the unit
  --opencl            the same arithmetic as a function in OpenCL C
  --testbench         a main for Verilator: the pipeline beside the function itself
  --unit-testbench    a main for Verilator: that module beside the function itself
  --stream            the datapath between two AXI4-Streams, module NAME_stream; with --record
                      the record memory between three, of which one has the records
  --stream-testbench  a main for Verilator: that module beside the function itself
  --dot               the graph, for Graphviz
  --report            operations, latency and delay bits, as JSON
  --graph             the graph with its schedule, as JSON

how to lower
  --record P,Q,...    of a function of one's own: parameters that come once, as a record, and
                      stay in a memory while many arguments for the others run past it
  --module NAME       name of the datapath's module: an identifier of SystemVerilog
  --latency K=N,...   cycles of each operator, and levels of lookup tables between registers:
LATENCIES                      of numbers with a mantissa of M stored bits, divide takes at most
                      M + 4 and square_root at most M + 3
  --family FAMILY     ecp5 (the default) or xilinx: how delays are built
  --delay K=N,...     longest delay in registers, narrow_registers (of conditions and slots) and
                      memory; longer ones of wide values take block RAM
  -o FILE             written whole or not at all
  --help
)";

using Subjects = std::vector<LoweringSubject>;

std::string names_of(const Subjects& subjects) {
  std::string names;
  for (const LoweringSubject& subject : subjects) {
    names += (names.empty() ? "" : ", ") + subject.name;
  }
  return names;
}

std::string help(const std::string& program, const Subjects& subjects,
                 std::string_view other_usage) {
  std::string latencies;
  for (const LatencyLimits& limits : kLatencyLimits) {
    char line[80];
    std::snprintf(line, sizeof line, "%22s%-15s %d to %d (%d)\n", "",
                  std::string(limits.name).c_str(), limits.least, limits.most,
                  Latencies{}.*limits.cycles);
    latencies += line;
  }
  std::string text(kHelp);
  for (const auto& [place, words] : {std::pair{"OTHER_USAGE", std::string(other_usage)},
                                     {"PROGRAM", program},
                                     {"SUBJECTS", names_of(subjects)},
                                     {"LATENCIES", latencies}}) {
    text.replace(text.find(place), std::string_view(place).size(), words);
  }
  return text;
}

constexpr int kMaxDelay = 9999;

struct Field {
  int* value;
  int least, most;
};

// Reads "a=1,b=2" into the numbers that `fields` names.
void read_numbers(const std::string& option, const std::string& text,
                  const std::map<std::string, Field>& fields) {
  // With a comma after each part, an empty text has one part, which is refused.
  std::istringstream parts(text + ',');
  for (std::string part; std::getline(parts, part, ',');) {
    const std::size_t equals = part.find('=');
    const auto field = fields.find(part.substr(0, equals));
    if (equals == std::string::npos || field == fields.end()) {
      std::string known;
      for (const auto& [name, unused] : fields) known += (known.empty() ? "" : ", ") + name;
      throw std::invalid_argument(option + ": '" + part + "' is not NAME=NUMBER with one of " +
                                  known);
    }
    const std::string number = part.substr(equals + 1);
    const auto& [value, least, most] = field->second;
    const bool is_number = !number.empty() && number.size() <= 4 &&
                           number.find_first_not_of("0123456789") == std::string::npos;
    const int given = is_number ? std::stoi(number) : -1;
    if (given < least || given > most) {
      throw std::invalid_argument(option + " " + field->first + " must be " +
                                  std::to_string(least) + " to " + std::to_string(most) +
                                  ", not '" + number + "'");
    }
    *value = given;
  }
}

// Reads "a,b".
std::vector<std::string> parameters_of(const std::string& option, const std::string& text) {
  std::vector<std::string> names;
  std::istringstream parts(text + ',');
  for (std::string part; std::getline(parts, part, ',');) {
    if (!is_identifier(part)) {
      throw std::invalid_argument(option + " takes names of parameters with commas between, not '" +
                                  text + "'");
    }
    names.push_back(part);
  }
  return names;
}

const LoweringSubject& subject_of(const std::string& name, const Subjects& subjects) {
  if (name.empty() && subjects.size() == 1) return subjects[0];
  if (name.empty()) throw std::invalid_argument("no form is given");
  for (const LoweringSubject& subject : subjects) {
    if (subject.name == name) return subject;
  }
  throw std::invalid_argument("unknown form '" + name + "': take one of " + names_of(subjects));
}

// Writes a partial file beside the target first, then renames it. A file with the right content
// keeps its time, so that nothing is built again for it.
void write_file(const std::string& path, const std::string& text) {
  if (std::ifstream before(path, std::ios::binary); before) {
    std::ostringstream content;
    content << before.rdbuf();
    if (content.str() == text) return;
  }
  const std::string partial = path + ".partial";
  std::ofstream file(partial, std::ios::binary);
  file << text;
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(partial, path, error);
  if (!file || error) {
    std::filesystem::remove(partial, error);
    throw std::runtime_error(path + ": cannot be written; is its folder there and writable?");
  }
}

int run(const std::string& program, const std::vector<std::string>& arguments,
        const Subjects& subjects, std::string_view other_usage) {
  LoweringOptions options;
  std::string form, file;
  std::optional<std::string> delay;
  std::string (*writer)(const LoweredDesign&) = datapath_module;
  const std::map<std::string, std::string (*)(const LoweredDesign&)> writers = {
      {"--unit", unit_module},
      {"--unit-testbench", unit_testbench_source},
      {"--schedule", schedule_header},
      {"--opencl", opencl_function},
      {"--testbench", testbench_source},
      {"--stream", stream_module},
      {"--stream-testbench", stream_testbench_source},
      {"--dot", dot_graph},
      {"--report", report_json},
      {"--graph", graph_json}};
  bool has_writer = false;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    const auto value = [&] {
      if (i + 1 == arguments.size()) throw std::invalid_argument(argument + " needs a value");
      return arguments[++i];
    };
    if (argument == "--help" || argument == "-h") {
      std::cout << help(program, subjects, other_usage);
      return 0;
    }
    if (const auto found = writers.find(argument); found != writers.end()) {
      if (has_writer) throw std::invalid_argument(argument + ": one thing to write at a time");
      has_writer = true;
      writer = found->second;
    } else if (argument == "--module") {
      options.module = value();
      try {
        check_module_name(options.module);
      } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(argument + ": " + error.what());
      }
    } else if (argument == "--record") {
      options.record = parameters_of(argument, value());
    } else if (argument == "--latency") {
      std::map<std::string, Field> fields;
      for (const LatencyLimits& limits : kLatencyLimits) {
        fields[std::string(limits.name)] = {&(options.latencies.*limits.cycles), limits.least,
                                            limits.most};
      }
      read_numbers(argument, value(), fields);
    } else if (argument == "--family") {
      const std::string family = value();
      if (family != "ecp5" && family != "xilinx") {
        throw std::invalid_argument("unknown family '" + family + "': take ecp5 or xilinx");
      }
      options.delays = delay_styles(family == "ecp5" ? Family::kEcp5 : Family::kXilinx);
    } else if (argument == "--delay") {
      delay = value();
    } else if (argument == "-o") {
      file = value();
    } else if (argument.starts_with('-') || !form.empty()) {
      throw std::invalid_argument("'" + argument + "' is not understood");
    } else {
      form = argument;
    }
  }
  DelayStyles& delays = options.delays;  // set after the family, wherever --delay comes
  if (delay) {
    read_numbers("--delay", *delay,
                 {{"registers", {&delays.registers_up_to, 0, kMaxDelay}},
                  {"narrow_registers", {&delays.narrow_registers_up_to, 0, kMaxDelay}},
                  {"memory", {&delays.memory_up_to, 0, kMaxDelay}}});
  }
  const std::string text = writer(subject_of(form, subjects).lower(options));
  if (file.empty()) {
    std::cout << text;
  } else {
    write_file(file, text);
  }
  return 0;
}

}  // namespace

int lowering_program(int argc, char** argv, const std::vector<LoweringSubject>& subjects,
                     std::string_view other_usage) {
  const std::string program = std::filesystem::path(argv[0]).filename().string();
  try {
    return run(program, {argv + 1, argv + argc}, subjects, other_usage);
  } catch (const std::invalid_argument& error) {
    std::cerr << program << ": " << error.what() << " (" << program << " --help)\n";
    return 2;
  } catch (const std::exception& error) {
    std::cerr << program << ": " << error.what() << "\n";
    return 1;
  }
}

}  // namespace emax
