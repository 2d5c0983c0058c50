#include "testbench/element/element_run.h"

#include <array>
#include <cstring>
#include <istream>
#include <map>
#include <ostream>
#include <sstream>
#include <stdexcept>

#include "hls/kernel/reduce.h"
#include "sw_model/base/error.h"
#include "sw_model/model/emax_model.h"

namespace emax {
namespace {

std::string hex(Word word) {
  char text[16];
  std::snprintf(text, sizeof text, "%08x", static_cast<unsigned>(word));
  return text;
}

std::vector<Word> read_words(std::istringstream& line, std::size_t count, const std::string& text) {
  std::vector<Word> words;
  std::string token;
  while (words.size() < count && line >> token) {
    std::size_t end = 0;
    unsigned long value = 0;
    try {
      value = std::stoul(token, &end, 16);
    } catch (const std::logic_error&) {
      end = 0;
    }
    if (end != token.size() || value > 0xffffffffu) break;
    words.push_back(static_cast<Word>(value));
  }
  if (words.size() != count) {
    throw Error("run of the element: '" + text + "' needs " + std::to_string(count) + " hex words");
  }
  return words;
}

}  // namespace

TriangleRecord<float> to_record(const RecordWords& words) {
  TriangleRecord<float> record;
  static_assert(sizeof record == sizeof words);
  std::memcpy(&record, words.data(), sizeof record);
  return record;
}

RecordWords to_words(const TriangleRecord<float>& record) {
  RecordWords words;
  std::memcpy(words.data(), &record, sizeof record);
  return words;
}

std::vector<std::size_t> records_of_pairs(const ElementRun& run) {
  std::vector<std::size_t> records;
  std::size_t record = 0;
  for (const Pair& pair : run.pairs) {
    records.push_back(record);
    record += pair.next_record ? 1 : 0;
  }
  return records;
}

bool is_legal(const ElementRun& run) {
  std::array<std::size_t, 1 << kPointBits> last_seen = {};  // pair + 1
  std::size_t record = 0;
  for (std::size_t i = 0; i < run.pairs.size(); ++i) {
    const Pair& pair = run.pairs[i];
    if (record >= run.records.size() || pair.index >= last_seen.size()) return false;
    if (pair.last && !pair.final) return false;
    std::size_t& seen = last_seen[pair.index];
    if (!pair.first && (seen == 0 || i + 1 - seen < kReadModifyWrite)) return false;
    seen = i + 1;
    record += pair.next_record ? 1 : 0;
  }
  return true;
}

Expected expected_of(const ElementRun& run) {
  if (!is_legal(run)) throw std::invalid_argument("a run that breaks the rules of the element");
  Expected expected;
  std::array<Word, 1 << kPointBits> nearest = {};
  WorstPoint<Word> worst = {};
  bool open = false;
  const auto records = records_of_pairs(run);
  for (std::size_t i = 0; i < run.pairs.size(); ++i) {
    const Pair& pair = run.pairs[i];
    const Vector3<float> p = {to_float(pair.point[0]), to_float(pair.point[1]),
                              to_float(pair.point[2])};
    const Word so_far = pair.first ? kInfinityWord : nearest[pair.index];
    const Word squared = minimum(so_far, pair_squared_bits(p, to_record(run.records[records[i]])));
    nearest[pair.index] = squared;
    if (!pair.final) continue;
    expected.nearest.push_back({squared, pair.last, i});
    const WorstPoint<Word> next = {squared, pair.index};
    worst = open ? maximum(worst, next) : next;
    open = !pair.last;
    if (pair.last) expected.worst.push_back({worst.squared_distance, worst.index, i});
  }
  return expected;
}

void write_run(std::ostream& out, const ElementRun& run) {
  const StreamPatterns& p = run.patterns;
  out << "# how willing the streams are: record, point (idles), nearest, worst (back-pressure)\n"
      << "patterns " << name_of(p.record) << ' ' << name_of(p.point) << ' ' << name_of(p.nearest)
      << ' ' << name_of(p.worst) << ' ' << p.seed << '\n';
  if (run.cut) out << "cut " << *run.cut << "  # cycles, then the next run's reset\n";
  out << "# records:";
  for (const char* name : kRecordWordNames) out << ' ' << name;
  out << '\n';
  for (const RecordWords& record : run.records) {
    out << "record";
    for (const Word word : record) out << ' ' << hex(word);
    out << '\n';
  }
  out << "# pairs: x y z, index, flags: first, final, next record, last of the block\n";
  for (const Pair& pair : run.pairs) {
    out << "pair";
    for (const Word word : pair.point) out << ' ' << hex(word);
    out << ' ' << hex(pair.index) << ' ' << (pair.first ? 'f' : '-') << (pair.final ? 'F' : '-')
        << (pair.next_record ? 'n' : '-') << (pair.last ? 'l' : '-') << '\n';
  }
  out << "end\n";
}

ElementRun read_run(std::istream& in) {
  ElementRun run;
  std::string text;
  while (std::getline(in, text)) {
    std::istringstream line(text.substr(0, text.find('#')));
    std::string word;
    if (!(line >> word)) continue;
    if (word == "end") {
      if (!is_legal(run)) throw Error("run of the element: its pairs break the streams' rules");
      return run;
    }
    if (word == "patterns") {
      std::string record, point, nearest, worst;
      line >> record >> point >> nearest >> worst >> run.patterns.seed;
      try {
        run.patterns = {pattern_named(record), pattern_named(point), pattern_named(nearest),
                        pattern_named(worst), run.patterns.seed};
      } catch (const std::invalid_argument& error) {
        throw Error("run of the element: '" + text + "': " + error.what());
      }
    } else if (word == "cut") {
      std::uint64_t cycles = 0;
      line >> cycles;
      run.cut = cycles;
    } else if (word == "record") {
      const auto words = read_words(line, kRecordWords, text);
      RecordWords record;
      std::copy(words.begin(), words.end(), record.begin());
      run.records.push_back(record);
    } else if (word == "pair") {
      const auto words = read_words(line, 4, text);
      std::string flags;
      line >> flags;
      if (flags.size() != 4) throw Error("run of the element: '" + text + "' needs four flags");
      run.pairs.push_back({{words[0], words[1], words[2]},
                           words[3],
                           flags[0] == 'f',
                           flags[1] == 'F',
                           flags[2] == 'n',
                           flags[3] == 'l'});
    } else {
      throw Error("run of the element: '" + text + "' is not a line of it");
    }
  }
  throw Error("run of the element: its text ends without 'end'");
}

}  // namespace emax
