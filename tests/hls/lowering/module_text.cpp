#include "tests/hls/lowering/module_text.h"

#include <algorithm>
#include <regex>
#include <set>

#include "hls/lowering/identifiers.h"

namespace emax::test {
namespace {

// Ports through which the modules of hls/rtl give their results.
const std::set<std::string> kResults = {"quotient", "root", "q",         "sum",    "product",
                                        "square",   "less", "read_data", "fitted", "opposite"};

std::vector<std::string> matches(const std::string& text, const std::regex& pattern, int group) {
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at) {
    found.push_back((*at)[static_cast<std::size_t>(group)]);
  }
  return found;
}

// Comments, strings, numbers with a base, and what is built only with probes or is a directive.
std::string without_what_is_no_name(const std::string& text) {
  static const std::regex comment("//[^\n]*"), string("\"[^\"]*\""), based("[0-9]+'[a-z][0-9a-f]+");
  static const std::regex probes("`ifdef EMAX_PROBES\n[^`]*`endif");
  std::string code = std::regex_replace(text, comment, "");
  code = std::regex_replace(code, probes, "");
  return std::regex_replace(std::regex_replace(code, string, "0"), based, "0");
}

void take_declaration(const std::string& statement, std::vector<std::string>& names) {
  static const std::regex head("^(input|output)?\\s*(logic|wire)\\s*(\\[[^\\]]*\\])?\\s*");
  static const std::regex name("\\w+");
  std::string list = std::regex_replace(statement, head, "");
  list = list.substr(0, list.find('='));
  for (const std::string& found : matches(list, name, 0)) names.push_back(found);
}

void take_ports(const std::string& head, ModuleText& module) {
  static const std::regex parameter("parameter\\s+int\\s+(\\w+)");
  module.inputs = matches(head, std::regex("input\\s+logic\\s*(?:\\[[^\\]]*\\])?\\s*(\\w+)"), 1);
  module.outputs = matches(head, std::regex("output\\s+logic\\s*(?:\\[[^\\]]*\\])?\\s*(\\w+)"), 1);
  module.parameters = matches(head, parameter, 1);
}

void take_names(const std::string& code, ModuleText& module) {
  static const std::regex name("([.\\w]?)\\b([A-Za-z_]\\w*)");
  for (std::sregex_iterator at(code.begin(), code.end(), name), end; at != end; ++at) {
    if ((*at)[1] == "." || is_keyword((*at)[2].str())) continue;
    module.used.push_back((*at)[2]);
  }
}

// "fp_add #(.LATENCY(ADD_LATENCY)) d_adder (.clk, .a(x), .b(y), .sum(d))"
void take_instance(const std::string& statement, ModuleText& module) {
  static const std::regex instance(
      "^\\w+\\s*(?:#\\(([\\s\\S]*)\\))?\\s*(\\w+)\\s*\\(([\\s\\S]*)\\)$");
  static const std::regex connection("\\.(\\w+)(\\()?(\\w+)?");
  std::smatch parts;
  if (!std::regex_match(statement, parts, instance)) {
    module.drivers["a statement that is not understood: " + statement] = 1;
    return;
  }
  module.instances.push_back(parts[2]);
  const std::string connections = parts[3];
  for (std::sregex_iterator at(connections.begin(), connections.end(), connection), end; at != end;
       ++at) {
    const std::string port = (*at)[1], signal = (*at)[3];
    if (!(*at)[2].matched) {  // .name: what drives an output of the unit is the datapath's
      module.used.push_back(port);
      if (std::ranges::find(module.outputs, port) != module.outputs.end()) ++module.drivers[port];
    } else if (kResults.contains(port)) {
      ++module.drivers[signal];
    }
  }
  take_names(parts[1].str() + ' ' + connections, module);
}

}  // namespace

ModuleText module_text(const std::string& text) {
  static const std::regex head_of("module\\s+(\\w+)\\s*((?:#\\([^;]*?\\)\\s*)?\\([^;]*\\));");
  static const std::regex process("always_ff @\\(posedge clk\\)\\s*(?:begin\\b)?");
  static const std::regex assignment("^(?:assign\\s+)?(\\w+)\\s*(?:<=|=)\\s*([\\s\\S]*)$");
  static const std::regex parameter("^localparam\\s+\\w+\\s*(?:\\[[^\\]]*\\])?\\s*(\\w+)\\s*=");
  ModuleText module;
  const std::string code = without_what_is_no_name(text);
  std::smatch head;
  if (!std::regex_search(code, head, head_of)) return module;
  module.name = head[1];
  take_ports(head[2], module);
  std::string body = std::regex_replace(head.suffix().str(), process, "");
  body = std::regex_replace(body, std::regex("\\bend(module)?\\b"), "");
  std::size_t begin = 0;
  for (std::size_t end = body.find(';'); end != std::string::npos; end = body.find(';', begin)) {
    std::string statement = body.substr(begin, end - begin);
    begin = end + 1;
    statement.erase(0, statement.find_first_not_of(" \n"));
    std::smatch parts;
    if (std::regex_search(statement, parts, parameter)) {
      module.parameters.push_back(parts[1]);
    } else if (statement.starts_with("wire unused_parts =")) {
      module.parameters.push_back("unused_parts");
      take_names(statement.substr(statement.find('=')), module);
    } else if (statement.starts_with("logic ")) {
      take_declaration(statement, module.signals);
    } else if (std::regex_match(statement, parts, assignment)) {
      ++module.drivers[parts[1]];
      take_names(parts[2], module);
    } else {
      take_instance(statement, module);
    }
  }
  return module;
}

std::string fault_of_module(const std::string& text) {
  const ModuleText module = module_text(text);
  if (module.outputs.empty()) return "there are no outputs";
  // A simulator gives the module's name to its instance at the top.
  std::set<std::string> declared = {module.name};
  for (const auto* names :
       {&module.inputs, &module.outputs, &module.signals, &module.parameters, &module.instances}) {
    for (const std::string& name : *names) {
      if (!is_identifier(name)) return "'" + name + "' is no identifier";
      if (is_keyword(name)) return name + " is a keyword";
      if (!declared.insert(name).second) return name + " is declared twice";
    }
  }
  for (const std::string& name : module.used) {
    if (!declared.contains(name)) return name + " is used but not declared";
  }
  std::map<std::string, int> drivers = module.drivers;
  for (const auto* names : {&module.outputs, &module.signals}) {
    for (const std::string& name : *names) {
      if (drivers[name] != 1) return name + " has " + std::to_string(drivers[name]) + " drivers";
      drivers.erase(name);
    }
  }
  return drivers.empty() ? "" : drivers.begin()->first + " is driven but is no signal";
}

}  // namespace emax::test
