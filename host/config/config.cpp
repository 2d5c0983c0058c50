#include "host/config/config.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

#include "sw_model/base/error.h"

namespace emax {
namespace {

constexpr std::string_view kOperatorsTable = "operators";

std::string in_quotes(std::string_view text) { return fmt::format("\"{}\"", text); }

// Reads values from a parsed file and names file and line in every refusal.
class Reader {
 public:
  explicit Reader(std::string file) : file_(std::move(file)) {}

  [[noreturn]] void refuse(const toml::source_region& where, const std::string& message) const {
    throw Error(fmt::format("{}:{}: {}", file_, where.begin.line, message));
  }

  const toml::table& table(const toml::node& node, std::string_view name) const {
    if (!node.is_table()) {
      refuse(node.source(), fmt::format("{} must be a table; write [{}]", name, name));
    }
    return *node.as_table();
  }

  double number(const toml::node& node, std::string_view name) const {
    const std::optional<double> value =
        node.is_number() ? node.value<double>() : std::optional<double>{};
    if (!value || !std::isfinite(*value)) {
      refuse(node.source(), fmt::format("{} must be a finite number", name));
    }
    return *value;
  }

  double number(const toml::node& node, std::string_view name, double least,
                double greatest) const {
    const double value = number(node, name);
    if (value < least || value > greatest) {
      refuse(node.source(), fmt::format("{} = {} is outside its domain; give {} to {}", name, value,
                                        least, greatest));
    }
    return value;
  }

  double whole(const toml::node& node, std::string_view name, double least, double greatest) const {
    const double value = number(node, name, least, greatest);
    if (value != std::floor(value)) {
      refuse(node.source(), fmt::format("{} = {} must be a whole number", name, value));
    }
    return value;
  }

  void unknown_key(const toml::key& key, std::string_view where,
                   const std::vector<std::string_view>& known) const {
    refuse(key.source(), fmt::format("unknown key {} in {}; known: {}", in_quotes(key.str()), where,
                                     fmt::join(known, ", ")));
  }

 private:
  std::string file_;
};

void read_operators(const Reader& reader, const toml::table& table, Settings& settings) {
  std::vector<std::string_view> known;
  known.reserve(kOperators.size());
  for (const OperatorEntry& entry : kOperators) known.push_back(entry.name);
  for (const auto& [key, node] : table) {
    const auto found = std::find(known.begin(), known.end(), key.str());
    if (found == known.end()) reader.unknown_key(key, "[search.operators]", known);
    settings.operator_frequencies[static_cast<std::size_t>(found - known.begin())] =
        reader.number(node, key.str(), 0, 1e9);
  }
  const auto& frequencies = settings.operator_frequencies;
  if (std::all_of(frequencies.begin(), frequencies.end(), [](double f) { return f == 0; })) {
    reader.refuse(table.source(), "every operator has frequency 0; give one a frequency above 0");
  }
}

void read_setting(const Reader& reader, const SettingInfo& info, const toml::node& node,
                  Settings& settings) {
  if (const auto* count = std::get_if<std::size_t Settings::*>(&info.member)) {
    settings.*(*count) =
        static_cast<std::size_t>(reader.whole(node, info.name, info.least, info.greatest));
  } else if (const auto* number = std::get_if<double Settings::*>(&info.member)) {
    settings.*(*number) = reader.number(node, info.name, info.least, info.greatest);
  } else if (const auto* flag = std::get_if<bool Settings::*>(&info.member)) {
    if (!node.is_boolean()) {
      reader.refuse(node.source(), fmt::format("{} must be true or false", info.name));
    }
    settings.*(*flag) = node.as_boolean()->get();
  } else {
    const auto* method = std::get_if<RepairMethod Settings::*>(&info.member);
    const std::string text = node.value_or(std::string());
    const auto found = std::find(kRepairMethods.begin(), kRepairMethods.end(), text);
    if (found == kRepairMethods.end()) {
      std::vector<std::string> choices;
      choices.reserve(kRepairMethods.size());
      for (std::string_view name : kRepairMethods) choices.push_back(in_quotes(name));
      reader.refuse(node.source(),
                    fmt::format("{} must be one of {}", info.name, fmt::join(choices, ", ")));
    }
    settings.*(*method) = static_cast<RepairMethod>(found - kRepairMethods.begin());
  }
}

void read_search(const Reader& reader, const toml::table& table, Settings& settings) {
  std::vector<std::string_view> known;
  for (const SettingInfo& info : setting_infos()) known.push_back(info.name);
  for (const auto& [key, node] : table) {
    if (key.str() == kOperatorsTable) {
      read_operators(reader, reader.table(node, "search.operators"), settings);
      continue;
    }
    const auto found = std::find(known.begin(), known.end(), key.str());
    if (found == known.end()) reader.unknown_key(key, "[search]", known);
    read_setting(reader, setting_infos()[static_cast<std::size_t>(found - known.begin())], node,
                 settings);
  }
}

// `own`: the parameter as it comes, whose domain may be narrowed.
void read_gene(const Reader& reader, const toml::table& table, const Parameter& own,
               Parameter& gene) {
  const std::string label = "genes." + in_quotes(own.name);
  bool has_standard = false;
  if (table.contains("lower") || table.contains("upper")) gene.fixed.reset();
  for (const auto& [key, node] : table) {
    const std::string name = label + '.' + std::string(key.str());
    const auto value = [&](const toml::node& n) {
      return own.is_whole() ? reader.whole(n, name, own.lower, own.upper)
                            : reader.number(n, name, own.lower, own.upper);
    };
    if (key.str() == "lower") {
      gene.lower = value(node);
    } else if (key.str() == "upper") {
      gene.upper = value(node);
    } else if (key.str() == "standard") {
      gene.standard = value(node);
      has_standard = true;
    } else if (key.str() == "fixed") {
      gene.fixed = value(node);
    } else {
      reader.unknown_key(key, fmt::format("[{}]", label), {"lower", "upper", "standard", "fixed"});
    }
  }
  if (gene.lower > gene.upper) {
    reader.refuse(table.source(), fmt::format("{}: lower = {} is above upper = {}; exchange them",
                                              label, gene.lower, gene.upper));
  }
  const double nearest = std::clamp(gene.standard, gene.lower, gene.upper);
  if (has_standard && nearest != gene.standard) {
    reader.refuse(table.source(),
                  fmt::format("{}: standard = {} is outside lower = {} to upper = {}; move it",
                              label, gene.standard, gene.lower, gene.upper));
  }
  gene.standard = nearest;
}

std::size_t position(const Reader& reader, const toml::key& key,
                     std::span<const Parameter> parameters) {
  const auto found = std::ranges::find(parameters, key.str(), &Parameter::name);
  if (found == parameters.end()) {
    std::vector<std::string_view> names;
    for (const Parameter& p : parameters) names.push_back(p.name);
    reader.refuse(key.source(), fmt::format("unknown gene {}; this chain has: {}",
                                            in_quotes(key.str()), fmt::join(names, ", ")));
  }
  return static_cast<std::size_t>(found - parameters.begin());
}

LinearConstraint read_linear(const Reader& reader, const toml::table& table,
                             std::span<const Parameter> parameters) {
  LinearConstraint constraint;
  int bounds = 0;
  for (const auto& [key, node] : table) {
    if (key.str() == "terms") {
      if (!node.is_table()) {
        reader.refuse(node.source(), "terms must be { \"gene\" = coefficient, ... }");
      }
      for (const auto& [gene, coefficient] : *node.as_table()) {
        constraint.terms.emplace_back(position(reader, gene, parameters),
                                      reader.number(coefficient, gene.str()));
      }
    } else if (key.str() == "at_most" || key.str() == "equals") {
      constraint.relation = key.str() == "equals" ? LinearConstraint::Relation::kEqual
                                                  : LinearConstraint::Relation::kAtMost;
      constraint.bound = reader.number(node, key.str());
      ++bounds;
    } else {
      reader.unknown_key(key, "[[linear]]", {"terms", "at_most", "equals"});
    }
  }
  if (constraint.terms.empty() || bounds != 1) {
    reader.refuse(table.source(), "[[linear]] needs terms and one of at_most and equals");
  }
  std::sort(constraint.terms.begin(), constraint.terms.end());
  return constraint;
}

double start_value(const Parameter& gene) { return gene.fixed.value_or(gene.standard); }

void check_start(const Reader& reader, const toml::table& table, const Config& config,
                 const LinearConstraint& constraint) {
  double sum = 0;
  double scale = std::abs(constraint.bound);
  for (const auto& [gene, coefficient] : constraint.terms) {
    const double term = coefficient * start_value(config.genes[gene]);
    sum += term;
    scale += std::abs(term);
  }
  const bool equal = constraint.relation == LinearConstraint::Relation::kEqual;
  if (equal ? std::abs(sum - constraint.bound) <= 1e-12 * scale : sum <= constraint.bound) return;
  reader.refuse(table.source(),
                fmt::format("the standard values give {} where {} {} is asked; change the "
                            "constraint or the standard of its genes",
                            sum, equal ? "exactly" : "at most", constraint.bound));
}

// "whole number; only with method = 0", or "0: gp3, 1: poisson".
std::string kind_text(const Parameter& p, std::span<const Parameter> all) {
  std::string text = p.kind == Gene::Kind::kInteger ? "whole number" : "number";
  if (p.kind == Gene::Kind::kCategorical) {
    text.clear();
    for (std::size_t i = 0; i < p.categories.size(); ++i) {
      text += fmt::format("{}{}: {}", i == 0 ? "" : ", ", i, p.categories[i]);
    }
  }
  if (p.only_with) {
    text += fmt::format("; only {} {} = {}", p.only_with->unless ? "without" : "with",
                        all[p.only_with->gene].name, p.only_with->category);
  }
  return text;
}

std::string number_text(double value) { return fmt::format("{}", value); }

std::string value_text(const SettingInfo& info, const Settings& settings) {
  if (const auto* count = std::get_if<std::size_t Settings::*>(&info.member)) {
    return fmt::format("{}", settings.*(*count));
  }
  if (const auto* number = std::get_if<double Settings::*>(&info.member)) {
    return number_text(settings.*(*number));
  }
  if (const auto* flag = std::get_if<bool Settings::*>(&info.member)) {
    return settings.*(*flag) ? "true" : "false";
  }
  const auto* method = std::get_if<RepairMethod Settings::*>(&info.member);
  return in_quotes(kRepairMethods[static_cast<std::size_t>(settings.*(*method))]);
}

}  // namespace

Config default_config(std::span<const Parameter> parameters) {
  Config config;
  config.genes.assign(parameters.begin(), parameters.end());
  return config;
}

std::string default_config_text(std::span<const Parameter> parameters) {
  const Settings settings;
  std::string text =
      "# What the search may do. Every key may be left out; it then has the value shown here.\n\n"
      "[search]\n";
  for (const SettingInfo& info : setting_infos()) {
    text += fmt::format("# {}\n{} = {}\n", info.meaning, info.name, value_text(info, settings));
  }
  text += fmt::format(
      "\n# How often each operator makes the offspring, relative to the others.\n"
      "[search.{}]\n",
      kOperatorsTable);
  for (const OperatorEntry& entry : kOperators) {
    text += fmt::format("{} = {}\n", entry.name, number_text(entry.standard_frequency));
  }
  text +=
      "\n# The parameters that are searched. lower and upper may narrow the domain; standard is "
      "the "
      "value\n# the search starts from; fixed = VALUE takes a parameter out of the search, lower "
      "and upper\n# in its place put it back.\n";
  for (const Parameter& p : parameters) {
    text += fmt::format("\n# {} ({})\n[genes.{}]\n", p.meaning, kind_text(p, parameters),
                        in_quotes(p.name));
    text += p.fixed ? fmt::format("fixed = {}  # lower = {}, upper = {}\n", number_text(*p.fixed),
                                  number_text(p.lower), number_text(p.upper))
                    : fmt::format("lower = {}\nupper = {}\nstandard = {}\n", number_text(p.lower),
                                  number_text(p.upper), number_text(p.standard));
  }
  const std::string first = parameters.empty() ? "gene" : parameters.front().name;
  const std::string last = parameters.empty() ? "gene" : parameters.back().name;
  text += fmt::format(
      "\n# Linear constraints, as many as wanted; at_most or equals:\n"
      "# [[linear]]\n# terms = {{ {} = 1, {} = -2 }}\n# at_most = 100\n",
      in_quotes(first), in_quotes(last));
  return text;
}

Config read_config(const std::filesystem::path& path, std::span<const Parameter> parameters) {
  const std::string file = path.string();
  std::error_code absent;
  if (std::filesystem::exists(path, absent) && !std::filesystem::is_regular_file(path, absent)) {
    throw Error(file + ": is not a regular file; give a configuration file");
  }
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream content;
  if (!stream || !(content << stream.rdbuf())) {
    std::error_code ignored;
    const bool empty = std::filesystem::is_regular_file(path, ignored) &&
                       std::filesystem::file_size(path, ignored) == 0;
    if (!empty) throw Error(file + ": cannot be read; give a readable configuration file");
  }
  toml::table root;
  const Reader reader(file);
  try {
    root = toml::parse(content.str(), file);
  } catch (const toml::parse_error& error) {
    reader.refuse(error.source(), fmt::format("{}; mend the TOML", error.description()));
  }

  Config config = default_config(parameters);
  std::vector<std::pair<const toml::table*, LinearConstraint>> linear;
  for (const auto& [key, node] : root) {
    if (key.str() == "search") {
      read_search(reader, reader.table(node, "search"), config.search);
    } else if (key.str() == "genes") {
      for (const auto& [gene, settings] : reader.table(node, "genes")) {
        const std::size_t i = position(reader, gene, parameters);
        read_gene(reader, reader.table(settings, "genes." + in_quotes(gene.str())), parameters[i],
                  config.genes[i]);
      }
    } else if (key.str() == "linear") {
      if (!node.is_array_of_tables()) {
        reader.refuse(node.source(), "linear must be a list of tables; write [[linear]]");
      }
      for (const toml::node& entry : *node.as_array()) {
        const toml::table& table = *entry.as_table();
        linear.emplace_back(&table, read_linear(reader, table, parameters));
      }
    } else {
      reader.unknown_key(key, "the file", {"search", "genes", "linear"});
    }
  }
  for (auto& [table, constraint] : linear) {
    check_start(reader, *table, config, constraint);
    config.linear.push_back(std::move(constraint));
  }
  return config;
}

std::vector<std::pair<std::string, std::string>> named_values(const Config& config) {
  std::vector<std::pair<std::string, std::string>> values;
  for (const SettingInfo& info : setting_infos()) {
    values.emplace_back(fmt::format("search.{}", info.name), value_text(info, config.search));
  }
  for (std::size_t i = 0; i < kOperators.size(); ++i) {
    values.emplace_back(fmt::format("search.{}.{}", kOperatorsTable, kOperators[i].name),
                        number_text(config.search.operator_frequencies[i]));
  }
  for (const Parameter& gene : config.genes) {
    values.emplace_back("genes." + gene.name,
                        gene.fixed
                            ? number_text(*gene.fixed)
                            : fmt::format("{} to {} from {}", number_text(gene.lower),
                                          number_text(gene.upper), number_text(gene.standard)));
  }
  for (std::size_t i = 0; i < config.linear.size(); ++i) {
    const LinearConstraint& constraint = config.linear[i];
    std::string text;
    for (const auto& [gene, coefficient] : constraint.terms) {
      text += fmt::format("{} {} + ", number_text(coefficient), config.genes[gene].name);
    }
    const bool equal = constraint.relation == LinearConstraint::Relation::kEqual;
    values.emplace_back(fmt::format("linear.{}", i),
                        fmt::format("{}0 {} {}", text, equal ? "=" : "<=", constraint.bound));
  }
  return values;
}

Problem make_problem(const Config& config, std::string_view monotone_gene) {
  Problem problem;
  Genes start;
  for (const Parameter& gene : config.genes) {
    if (gene.name == monotone_gene && !gene.fixed && gene.lower < gene.upper) {
      problem.monotone_gene = problem.genes.size();
    }
    problem.genes.push_back(static_cast<const Gene&>(gene));
    if (gene.fixed) problem.genes.back().lower = problem.genes.back().upper = *gene.fixed;
    start.push_back(start_value(gene));
  }
  problem.linear = config.linear;
  problem.starts = {start};
  // Each other category once, the rest as it is.
  for (std::size_t i = 0; i < problem.genes.size(); ++i) {
    const Gene& gene = problem.genes[i];
    if (gene.kind != Gene::Kind::kCategorical) continue;
    const auto categories = static_cast<std::size_t>(gene.upper - gene.lower) + 1;
    for (std::size_t c = 0; c < categories; ++c) {
      const double category = gene.lower + static_cast<double>(c);
      if (category == start[i]) continue;
      problem.starts.push_back(start);
      problem.starts.back()[i] = category;
    }
  }
  return problem;
}

}  // namespace emax
