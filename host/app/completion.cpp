#include "host/app/completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

namespace emax {
namespace {

// An option as a shell completes it.
struct CompletedOption {
  std::vector<std::string> names;    // "--method", "-q"
  std::vector<std::string> choices;  // of its value, where there are few
  bool takes_value;
  std::string meaning;  // a few words
};

// The help up to its first pause, without what a script would have to quote.
std::string few_words(std::string_view help) {
  std::string words(help.substr(0, help.find_first_of(";:(")));
  std::erase_if(words, [](char c) {
    return std::string_view("'\"`\\[]$").find(c) != std::string_view::npos;
  });
  while (words.ends_with(' ')) words.pop_back();
  return words;
}

// CLI11 shows the choices of CLI::IsMember in the type: "TEXT:{quick,normal,deep}".
std::vector<std::string> choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{'), end = type.rfind('}');
  if (begin == std::string::npos || end == std::string::npos) return {};
  return CLI::detail::split(type.substr(begin + 1, end - begin - 1), ',');
}

std::vector<CompletedOption> options_of(const CLI::App& command) {
  std::vector<CompletedOption> options;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) continue;
    CompletedOption completed{{},
                              choices_of(*option),
                              option->get_items_expected_max() > 0,
                              few_words(option->get_description())};
    for (const std::string& name : option->get_lnames()) completed.names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) completed.names.push_back("-" + name);
    options.push_back(std::move(completed));
  }
  return options;
}

std::vector<std::string> names_of(const std::vector<CompletedOption>& options) {
  std::vector<std::string> names;
  for (const CompletedOption& option : options) {
    names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return names;
}

std::string for_bash(const CLI::App& app) {
  std::vector<std::string> first = names_of(options_of(app));
  std::string options, choices;
  for (const CLI::App* command : app.get_subcommands({})) {
    first.push_back(command->get_name());
    const std::vector<CompletedOption> all = options_of(*command);
    options += fmt::format("    {}) options=\"{}\" ;;\n", command->get_name(),
                           fmt::join(names_of(all), " "));
    for (const CompletedOption& option : all) {
      if (option.choices.empty()) continue;
      for (const std::string& name : option.names) {
        choices += fmt::format("    \"{} {}\") options=\"{}\" ;;\n", command->get_name(), name,
                               fmt::join(option.choices, " "));
      }
    }
  }
  return fmt::format(R"(_emax() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} options=
  case $COMP_CWORD in
    1) options="{}" ;;
    *) case "${{COMP_WORDS[1]}} $before" in
{}    esac ;;
  esac
  if [ -z "$options" ] && [[ $word == -* ]]; then
    case ${{COMP_WORDS[1]}} in
{}    esac
  fi
  if [ -n "$options" ]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
  else
    COMPREPLY=()
    compopt -o default 2>/dev/null
  fi
}}
complete -F _emax emax
)",
                     fmt::join(first, " "), choices, options);
}

std::string for_zsh(const CLI::App& app) {
  std::string commands, cases;
  for (const CLI::App* command : app.get_subcommands({})) {
    commands +=
        fmt::format("      '{}:{}'\n", command->get_name(), few_words(command->get_description()));
    cases += fmt::format("    {})\n      _arguments", command->get_name());
    for (const CompletedOption& option : options_of(*command)) {
      const std::string value = !option.takes_value ? ""
                                : option.choices.empty()
                                    ? ":value:_files"
                                    : fmt::format(":value:({})", fmt::join(option.choices, " "));
      for (const std::string& name : option.names) {
        cases += fmt::format(" \\\n        '{}[{}]{}'", name, option.meaning, value);
      }
    }
    cases += " \\\n        '*:file:_files' ;;\n";
  }
  return fmt::format(R"(#compdef emax
_emax() {{
  local -a commands
  if (( CURRENT == 2 )); then
    commands=(
{}    )
    _describe command commands
    return
  fi
  shift words
  (( CURRENT-- ))
  case $words[1] in
{}  esac
}}
compdef _emax emax
)",
                     commands, cases);
}

std::string for_fish(const CLI::App& app) {
  std::string script;
  for (const CLI::App* command : app.get_subcommands({})) {
    script += fmt::format("complete -c emax -f -n __fish_use_subcommand -a {} -d '{}'\n",
                          command->get_name(), few_words(command->get_description()));
    for (const CompletedOption& option : options_of(*command)) {
      script +=
          fmt::format("complete -c emax -n '__fish_seen_subcommand_from {}'", command->get_name());
      for (const std::string& name : option.names) {
        script += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      }
      if (!option.choices.empty()) {
        script += fmt::format(" -x -a '{}'", fmt::join(option.choices, " "));
      } else if (option.takes_value) {
        script += " -r";
      }
      script += fmt::format(" -d '{}'\n", option.meaning);
    }
  }
  return script;
}

}  // namespace

std::string completion_script(const CLI::App& app, std::string_view shell) {
  if (shell == "zsh") return for_zsh(app);
  return shell == "fish" ? for_fish(app) : for_bash(app);
}

}  // namespace emax
