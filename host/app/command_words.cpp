#include "host/app/command_words.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/app/option_checks.h"
#include "host/files/input_file.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

std::string suggestion(std::string_view word, std::span<const std::string> candidates) {
  const std::string meant = closest(word, candidates);
  return meant.empty() ? "" : fmt::format(": did you mean {}?", meant);
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

bool is_option(std::string_view word) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return word.starts_with("--") ? word.size() > 2
                                : word.size() > 1 && word[0] == '-' && is_letter(word[1]);
}

// Walks over the words of one command.
class OptionWords {
 public:
  OptionWords(const CLI::App& command, bool is_program)
      : command_(command), is_program_(is_program) {}

  void add(const std::string& word, std::vector<std::string>& words) {
    words.push_back(word);
    if (only_files_) return;
    if (awaits_value_) {
      awaits_value_ = false;
    } else if (word == "--") {
      only_files_ = true;
    } else if (is_option(word)) {
      add_option(word, words);
    }
  }

 private:
  void add_option(const std::string& word, std::vector<std::string>& words) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const CLI::Option* option = command_.get_option_no_throw(name);
    if (option == nullptr && !word.starts_with("--")) {
      // A short option may be followed by its value without a blank: -ox.ply.
      if (command_.get_option_no_throw(word.substr(0, 2)) != nullptr) return;
    }
    if (option == nullptr) {
      throw Error(fmt::format("there is no option {}{}; see emax {}--help", printable(name),
                              suggestion(name, option_names(command_)),
                              is_program_ ? "" : command_.get_name() + " "));
    }
    if (option->get_items_expected_min() == 0) return;
    awaits_value_ = equals == word.npos;
    if (!awaits_value_ && !word.starts_with("--")) {
      words.back() = name;
      words.push_back(word.substr(equals + 1));
    }
  }

  const CLI::App& command_;
  bool is_program_;
  bool awaits_value_ = false;
  bool only_files_ = false;
};

}  // namespace

std::vector<std::string> checked_words(const CLI::App& app, std::span<char* const> words) {
  const std::vector<std::string> given(words.begin() + (words.empty() ? 0 : 1), words.end());
  for (const std::string& word : given) {
    if (is_utf8(word)) continue;
    throw Error(printable(word) + ": is not UTF-8, as certificates need; rename the file");
  }
  std::vector<std::string> checked;
  if (given.empty()) return checked;
  const CLI::App* command = &app;
  std::size_t first = 0;
  if (!given[0].starts_with('-')) {
    const std::vector<std::string> names = command_names(app);
    const auto known = std::ranges::find(names, given[0]);
    if (known == names.end()) {
      throw Error(fmt::format("there is no command '{}'{}; the commands are {}, see emax --help",
                              printable(given[0]), suggestion(given[0], names),
                              fmt::join(names, ", ")));
    }
    command = app.get_subcommand(given[0]);
    checked.push_back(given[0]);
    first = 1;
  }
  OptionWords options(*command, command == &app);
  for (std::size_t i = first; i < given.size(); ++i) options.add(given[i], checked);
  return checked;
}

std::string closest(std::string_view word, std::span<const std::string> candidates) {
  constexpr std::size_t kBeginning = 4;  // "--co"
  std::string best;
  std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const bool begins = word.size() >= kBeginning && candidate.starts_with(word);
    const std::size_t distance = begins ? 1 : edit_distance(word, candidate);
    if (distance >= least) continue;
    least = distance;
    best = candidate;
  }
  return best;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Rows of the table for the prefixes of `a` of the lengths i - 2, i - 1 and i.
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] =
          std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

}  // namespace emax
