// C simulation: drives the synthesizable top with random blocks beside the golden model and
// compares every answered word. Exit code 0 when all agree.
//
//   emax_csim [--seed N] [--blocks N] [--words FILE] [--fault | --no-flush]
//
// --fault sends the top one point with a changed bit. --no-flush does not flush subnormals. Both
// must be caught. --words writes all blocks for csim_replay, the fault included.

#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string_view>
#include <vector>

#include "sw_model/base/float_bits.h"
#include "sw_model/model/emax_model.h"
#include "sw_model/model/triangle_frame.h"
#include "sw_model/protocol/commands.h"
#include "testbench/csim/run_top.h"

namespace emax {
namespace {

struct Options {
  std::uint64_t seed = 1;
  std::uint64_t blocks = 200;
  bool fault = false;
  bool flush = true;
  const char* words = nullptr;
};

struct Block {
  std::vector<Vector3<float>> points;
  std::vector<TriangleRecord<float>> records;
};

// Every fourth triangle is a sliver or degenerate; sizes vary from one word to a full block. Every
// eighth block is so small that its squared distances lie around the least normal number.
Block random_block(std::mt19937_64& engine) {
  const double scale = engine() % 8 == 0 ? 0x1p-62 : 1;
  const auto number = [&engine, scale] {
    return (static_cast<double>(engine() >> 11) * 0x1p-52 - 1) * scale;
  };
  const auto point = [&number] {
    const double x = number(), y = number(), z = number();
    return Point(x, y, z);
  };
  Block block;
  const std::uint64_t most = engine() % 8 == 0 ? kMaxBlockPoints : 64;
  const std::uint64_t points = 1 + engine() % most;
  for (std::uint64_t i = 0; i < points; ++i) {
    const Eigen::Vector3f p = point().cast<float>();
    block.points.push_back({p.x(), p.y(), p.z()});
  }
  const std::uint64_t records = 1 + engine() % 40;
  for (std::uint32_t i = 0; i < records; ++i) {
    const Point a = point(), b = point(), off = point();
    const double along = number() / scale;
    const Point c = i % 4 == 3 ? Point(a + along * (b - a) + 1e-6 * off) : off;
    block.records.push_back(make_record(make_frame({a, b, c}), i));
  }
  return block;
}

std::vector<Word> expected_answer(const Block& block) {
  const std::vector<std::uint32_t> nearest = nearest_squared_bits(block.points, block.records);
  const EmaxResult worst = worst_of(nearest);
  std::vector<Word> answer = {
      command_header(kReduce, static_cast<Word>(kAnswerWorst + nearest.size()))};
  answer.insert(answer.end(), nearest.begin(), nearest.end());
  answer.insert(answer.end(), {worst.squared_bits, worst.worst_point});
  return answer;
}

void print_words(std::FILE* file, const std::vector<Word>& words) {
  std::fprintf(file, "%zx", words.size());
  for (const Word word : words) std::fprintf(file, " %" PRIx32, word);
}

int run(const Options& options) {
  std::mt19937_64 engine(options.seed);
  std::FILE* const file = options.words != nullptr ? std::fopen(options.words, "w") : nullptr;
  if (options.words != nullptr && file == nullptr) {
    std::fprintf(stderr, "%s: cannot be written\n", options.words);
    return 2;
  }
  std::uint64_t pairs = 0, mismatches = 0;
  for (std::uint64_t i = 0; i < options.blocks; ++i) {
    const Block block = random_block(engine);
    std::vector<Word> words;
    append_load_points(words, block.points);
    append_records(words, block.records);
    append_reduce(words, true);
    if (options.fault && i == options.blocks / 2) words[1] ^= 1u << 30;  // of the first x
    const std::vector<Word> answer = run_top(words, options.flush);
    const std::vector<Word> expected = expected_answer(block);
    if (file != nullptr) {
      print_words(file, words);
      std::fprintf(file, " ");
      print_words(file, expected);
      std::fprintf(file, "\n");
    }
    for (std::size_t w = 0; w < expected.size(); ++w) {
      if (w < answer.size() && answer[w] == expected[w]) continue;
      if (mismatches++ == 0) {
        std::printf("block %llu, answer word %zu: model %s\n", static_cast<unsigned long long>(i),
                    w, describe_bits(expected[w]).c_str());
        std::printf("  top %s\n",
                    w < answer.size() ? describe_bits(answer[w]).c_str() : "gave no such word");
      }
    }
    pairs += block.points.size() * block.records.size();
  }
  if (file != nullptr && std::fclose(file) != 0) {
    std::fprintf(stderr, "%s: could not be written to its end\n", options.words);
    return 2;
  }
  std::printf("csim: seed %llu, %llu pairs, %llu mismatches\n",
              static_cast<unsigned long long>(options.seed), static_cast<unsigned long long>(pairs),
              static_cast<unsigned long long>(mismatches));
  return mismatches == 0 ? 0 : 1;
}

bool parse(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    char* end = nullptr;
    if (argument == "--fault") {
      options.fault = true;
    } else if (argument == "--no-flush") {
      options.flush = false;
    } else if (argument == "--words" && i + 1 < argc) {
      options.words = argv[++i];
    } else if ((argument == "--seed" || argument == "--blocks") && i + 1 < argc) {
      (argument == "--seed" ? options.seed : options.blocks) = std::strtoull(argv[++i], &end, 10);
      if (*end != '\0') return false;
    } else {
      return false;
    }
  }
  return options.blocks > 0;
}

}  // namespace
}  // namespace emax

int main(int argc, char** argv) {
  emax::Options options;
  if (!emax::parse(argc, argv, options)) {
    std::fprintf(
        stderr, "usage: emax_csim [--seed N] [--blocks N] [--words FILE] [--fault | --no-flush]\n");
    return 2;
  }
  return emax::run(options);
}
