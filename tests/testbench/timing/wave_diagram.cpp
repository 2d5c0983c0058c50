#include "wave_diagram.h"

#include <stdexcept>

namespace emax {
namespace {

// One signal: WaveDrom's letter for each cycle, and the names of the words that begin.
struct Wave {
  std::string letters, names, before;

  void add(const WaveValue& now) {
    const bool goes_on = !letters.empty() && now.value == before;
    letters += goes_on ? "." : now.is_wire ? now.value : now.value.empty() ? "x" : "=";
    if (letters.back() == '=') names += (names.empty() ? "\"" : ", \"") + now.value + "\"";
    before = now.value;
  }

  std::string line(const std::string& signal) const {
    return "    {\"name\": \"" + signal + "\", \"wave\": \"" + letters + "\"" +
           (names.empty() ? "" : ", \"data\": [" + names + "]") + "}";
  }
};

void expect_still(const std::vector<WaveCycle>& cycles, std::size_t first, std::size_t last) {
  for (std::size_t cycle = first; cycle < last; ++cycle) {
    for (std::size_t i = 0; i < cycles[cycle].size(); ++i) {
      if (cycles[cycle][i].is_wire && cycles[cycle][i].value != cycles[cycle + 1][i].value) {
        throw std::invalid_argument(cycles[cycle][i].signal + " changes in a gap, after cycle " +
                                    std::to_string(cycle));
      }
    }
  }
}

}  // namespace

std::string wave_json(const std::vector<WaveCycle>& cycles, const std::vector<WaveRange>& shown,
                      std::size_t origin) {
  std::vector<Wave> waves(cycles.front().size());
  std::string clock, numbers;
  const auto number = [&](const std::string& text) { numbers += text + " "; };
  for (const WaveRange& range : shown) {
    if (!clock.empty()) {
      clock += '|';
      for (Wave& wave : waves) wave.letters += '|';
      number("…");
    }
    for (std::size_t cycle = range.first; cycle <= range.last; ++cycle) {
      clock += clock.empty() ? 'p' : '.';
      for (std::size_t i = 0; i < waves.size(); ++i) waves[i].add(cycles.at(cycle)[i]);
      number(std::to_string(static_cast<long>(cycle) - static_cast<long>(origin)));
    }
  }
  for (std::size_t i = 1; i < shown.size(); ++i) {
    expect_still(cycles, shown[i - 1].last, shown[i].first);
  }
  std::string text = "{\n  \"signal\": [\n    {\"name\": \"clk\", \"wave\": \"" + clock + "\"}";
  for (std::size_t i = 0; i < waves.size(); ++i) {
    text += ",\n" + waves[i].line(cycles.front()[i].signal);
  }
  // WaveDrom shows one number more than there are cycles: one without width.
  return text + "\n  ],\n  \"foot\": {\"tock\": \"" + numbers + "\\u200b\"}\n}\n";
}

}  // namespace emax
