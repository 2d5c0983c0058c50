#include "tests/hls/lowering/samples.h"

#include <algorithm>

#include "sw_model/model/triangle_frame.h"
#include "testbench/stimuli/stimuli.h"

namespace emax::test {
namespace {

template <class Record>
std::vector<Word> words_of(const Record& record) {
  std::vector<Word> words(sizeof record / sizeof(Word));
  std::memcpy(words.data(), &record, sizeof record);
  return words;
}

template <class MakeRecord>
std::vector<Sample> samples(std::uint64_t seed, std::size_t count, const MakeRecord& make) {
  Random random(seed);
  std::vector<Sample> all;
  const auto stimuli = all_stimuli(seed);
  while (all.size() < count) {
    for (const Stimulus& s : stimuli) {
      const Normalization normalization = normalization_of(s.cloud);
      const auto points = normalized_points(s.cloud, normalization);
      for (int i = 0; i < 200; ++i) {
        const auto triangle = random.below(s.triangles.size());
        std::array<Point, 3> corners = s.mesh().corners(triangle);
        for (Point& corner : corners) corner = normalization.apply(corner);
        const Vector3<float>& p = points[random.below(points.size())];
        Sample sample{words_of(make(make_frame(corners), triangle)),
                      {to_word(p.x), to_word(p.y), to_word(p.z)}};
        const int spoiled = i % 4;  // how many of 16 words become words of any kind
        for (std::size_t w = 0; w < sample.record.size() + 3; ++w) {
          if (random.below(16) >= static_cast<std::uint32_t>(spoiled)) continue;
          (w < sample.record.size() ? sample.record[w] : sample.point[w - sample.record.size()]) =
              any_word(random);
        }
        all.push_back(sample);
      }
    }
    Sample sample = all.back();
    for (int i = 0; i < 500; ++i) {
      for (Word& word : sample.record) word = any_word(random);
      for (Word& word : sample.point) word = any_word(random);
      all.push_back(sample);
    }
  }
  return all;
}

}  // namespace

std::vector<Sample> record_samples(std::uint64_t seed, std::size_t count) {
  return samples(seed, count, make_record);
}
std::vector<Sample> barycentric_samples(std::uint64_t seed, std::size_t count) {
  return samples(seed, count, make_barycentric_record);
}

std::vector<Word> input_words(const DataflowGraph& graph, const Sample& sample) {
  std::vector<Word> words(sample.point.begin(), sample.point.end());
  for (std::size_t i = words.size(); i < graph.inputs().size(); ++i) {
    const Input& input = graph.inputs()[i];
    const Word word = sample.record[input.record_bit / 32] >> (input.record_bit % 32);
    words.push_back(graph.node(input.node).type.kind == ValueKind::kCondition ? word & 1u : word);
  }
  return words;
}

}  // namespace emax::test
