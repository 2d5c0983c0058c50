#include "testbench/cosimulation/element_tests.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "sw_model/model/triangle_frame.h"
#include "testbench/stimuli/stimuli.h"

namespace emax {
namespace {

using PointWords = std::array<Word, 3>;

// A stimulus as words.
struct Material {
  std::vector<PointWords> points;
  std::vector<RecordWords> records;

  const PointWords& any_point(Random& random) const { return points[random.below(points.size())]; }
  const RecordWords& any_record(Random& random) const {
    return records[random.below(records.size())];
  }
};

PointWords words_of(const Vector3<float>& p) { return {to_word(p.x), to_word(p.y), to_word(p.z)}; }

// The cloud and, for every triangle, points on it, next to it in its plane, and above it.
Material material_of(const test::Stimulus& s, Random& random) {
  std::vector<Point> cloud = s.cloud;
  for (std::size_t i = 0; i < std::min<std::size_t>(s.triangles.size(), 400); ++i) {
    const auto corners = s.mesh().corners(i);
    const Point u = corners[1] - corners[0], v = corners[2] - corners[0];
    const double a = random.uniform(-0.5, 1.5), b = random.uniform(-0.5, 1.5);
    cloud.push_back(corners[0] + a * u + b * v);
    cloud.push_back(cloud.back() + random.uniform(-0.3, 0.3) * u.cross(v));
    cloud.push_back(corners[random.below(3)]);
  }
  const Normalization normalization = normalization_of(s.cloud);
  Material material;
  for (const Vector3<float>& p : normalized_points(cloud, normalization)) {
    material.points.push_back(words_of(p));
  }
  for (const TriangleRecord<float>& r : make_records(s.mesh(), normalization)) {
    material.records.push_back(to_words(r));
  }
  return material;
}

// The material of the stimulus with this name; made once, from a seed of its own.
const Material& material(const std::string& name) {
  static const std::map<std::string, Material> all = [] {
    std::map<std::string, Material> made;
    Random random(named_seed("material", 1));
    for (const test::Stimulus& s : test::all_stimuli(1)) made[s.name] = material_of(s, random);
    return made;
  }();
  return all.at(name);
}

const Material& any_material(Random& random) {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const test::Stimulus& s : test::all_stimuli(1)) all.push_back(s.name);
    return all;
  }();
  return material(names[random.below(names.size())]);
}

// Zeros, subnormals, the ends of the normal range, huge squares, infinities, NaNs of both kinds.
Word special_word(Random& random) {
  constexpr std::array<Word, 17> kSpecial = {
      0x00000000, 0x00000001, 0x007fffff, 0x00400000, 0x00800000, 0x00800001,
      0x3f800000, 0x3f7fffff, 0x5f7fffff, 0x5f800000, 0x7f7fffff, 0x7f000000,
      0x7f800000, 0x7f800001, 0x7fc00000, 0x7fffffff, 0x1f800000};
  return kSpecial[random.below(kSpecial.size())] | (random.word() & 0x80000000u);
}

StreamPatterns any_patterns(Random& random) {
  const auto any = [&random] { return static_cast<Pattern>(random.below(kPatterns)); };
  StreamPatterns patterns;
  patterns.record = any();
  patterns.point = any();
  patterns.nearest = any();
  patterns.worst = any();
  patterns.seed = random.bits();
  return patterns;
}

// Every pair has a record of its own and is final, so its distance is seen as it is.
void append_raw_pair(ElementRun& run, const PointWords& point, const RecordWords& record,
                     Random& random, std::size_t count) {
  const bool ends = run.pairs.size() + 1 == count || random.one_in(40);
  run.records.push_back(record);
  run.pairs.push_back({point, random.below(1u << kPointBits), true, true, true, ends});
}

using MakePair = std::function<void(Random&, PointWords&, RecordWords&)>;

// Raw pairs. Three of four runs have no idle cycles, so that the initiation interval is measured.
ElementTest raw_pairs(const std::string& name, std::uint64_t full_runs, const MakePair& make) {
  constexpr std::size_t kPairs = 2000;
  const auto runs = [make](std::uint64_t number, Random& random) {
    ElementRun run;
    PointWords point;
    RecordWords record;
    for (std::size_t i = 0; i < kPairs; ++i) {
      make(random, point, record);
      append_raw_pair(run, point, record, random, kPairs);
    }
    if (number % 4 == 3) run.patterns = any_patterns(random);
    return std::vector<ElementRun>{run};
  };
  return {"pairs: " + name, kPairsSlotBits, 40, full_runs, runs};
}

ElementTest material_pairs(const std::string& name, std::uint64_t full_runs) {
  return raw_pairs(name, full_runs, [name](Random& random, PointWords& p, RecordWords& r) {
    p = material(name).any_point(random);
    r = material(name).any_record(random);
  });
}

void random_bits(Random& random, PointWords& point, RecordWords& record) {
  for (Word& word : point) word = random.word();
  for (Word& word : record) word = random.word();
}

// Random words of nearly equal exponents, so that products and sums neither over- nor underflow.
void near_one(Random& random, PointWords& point, RecordWords& record) {
  const auto near = [&random] {
    return (random.word() & 0x807fffffu) | ((120 + random.below(16)) << 23);
  };
  for (Word& word : point) word = near();
  for (Word& word : record) word = near();
  record[kRecordWords - 1] = random.word();
}

void special_values(Random& random, PointWords& point, RecordWords& record) {
  const Material& from = material("random soup");
  point = from.any_point(random);
  record = from.any_record(random);
  for (std::uint32_t i = 1 + random.below(4); i > 0; --i) {
    const std::uint32_t place = random.below(3 + kRecordWords);
    (place < 3 ? point[place] : record[place - 3]) = special_word(random);
  }
}

// Material scaled by powers of two, so that squares under- and overflow.
void huge_and_tiny(Random& random, PointWords& point, RecordWords& record) {
  const Material& from = material("random soup");
  point = from.any_point(random);
  record = from.any_record(random);
  const std::uint32_t shift = random.below(120) << 23;
  const bool up = random.one_in(2);
  const auto scale = [&](Word& word) {
    const Word magnitude = word & 0x7fffffffu;
    const Word room = up ? 0x7f7fffffu - magnitude : magnitude;
    const Word step = std::min(shift, room & 0x7f800000u);
    word = (word & 0x80000000u) | (up ? magnitude + step : magnitude - step);
  };
  for (Word& word : point) scale(word);
  for (const std::uint32_t i : {0u, 1u, 2u, 12u, 15u, 18u}) scale(record[i]);
}

struct BlockShape {
  std::uint32_t most_points, most_records;
  bool specials = false;
};

void append_any_block(ElementRun& run, const Material& from, const BlockShape& shape,
                      Random& random) {
  std::vector<PointWords> points(1 + random.below(shape.most_points));
  std::vector<RecordWords> records(1 + random.below(shape.most_records));
  for (PointWords& point : points) {
    point = from.any_point(random);
    if (shape.specials && random.one_in(8)) point[random.below(3)] = special_word(random);
  }
  for (RecordWords& record : records) {
    record = from.any_record(random);
    if (shape.specials && random.one_in(4)) {
      record[random.below(kRecordWords)] = special_word(random);
    }
  }
  append_block(run, points, records);
}

ElementTest blocks(const std::string& name, std::uint32_t slot_bits, std::uint64_t quick,
                   std::uint64_t full, std::uint32_t blocks_a_run, const BlockShape& shape) {
  const auto runs = [=](std::uint64_t number, Random& random) {
    ElementRun run;
    for (std::uint32_t i = 0; i < blocks_a_run; ++i) {
      append_any_block(run, any_material(random), shape, random);
    }
    if (number % 2 == 1) run.patterns = any_patterns(random);
    return std::vector<ElementRun>{run};
  };
  ElementTest test{"blocks: " + name, slot_bits, quick, full, runs};
  // Passes over few points end before a device's element has a free slot for the next record.
  test.ii_is_one = slot_bits == kPairsSlotBits;
  return test;
}

// Equal distances everywhere: the lowest index must win, in blocks with and without a greater one.
std::vector<ElementRun> tied_blocks(std::uint64_t number, Random& random) {
  ElementRun run;
  const std::string name = number % 2 == 0 ? "level ties" : "duplicated";
  for (int i = 0; i < 8; ++i) append_any_block(run, material(name), {40, 6}, random);
  if (number % 4 == 3) run.patterns = any_patterns(random);
  return {run};
}

// Flags in any order that the rules allow: a point begins anew without having ended, ends twice, or
// stays in the memory over several blocks.
ElementRun any_flags(Random& random, std::size_t pairs) {
  const Material& from = any_material(random);
  ElementRun run;
  run.records.push_back(from.any_record(random));
  std::map<Word, std::size_t> seen;
  while (run.pairs.size() < pairs) {
    const bool whole = random.one_in(64);
    const Word index = random.below(whole ? 1u << kPointBits : 12);
    const auto before = seen.find(index);
    const bool first = before == seen.end() || random.one_in(10);
    if (!first && run.pairs.size() - before->second < kReadModifyWrite) continue;
    seen[index] = run.pairs.size();
    const bool final = random.one_in(3), next_record = random.one_in(3);
    run.pairs.push_back(
        {from.any_point(random), index, first, final, next_record, final && random.one_in(8)});
    if (next_record) run.records.push_back(from.any_record(random));
  }
  run.pairs.back().final = run.pairs.back().last = true;
  return run;
}

std::vector<ElementRun> free_flags(std::uint64_t number, Random& random) {
  ElementRun run = any_flags(random, 1500);
  if (number % 2 == 1) run.patterns = any_patterns(random);
  return {run};
}

// Crosses each idle pattern of the points with each back-pressure of the minima, while the other
// two streams take their patterns in turn. After 49 runs every pattern of an input has met every
// pattern of an output.
std::vector<ElementRun> crossed_patterns(std::uint64_t number, Random& random) {
  const auto pattern = [](std::uint64_t n) { return static_cast<Pattern>(n % kPatterns); };
  ElementRun run;
  if (number / 49 % 2 == 0) {
    append_any_block(run, any_material(random), {30, 40}, random);
    for (int i = 0; i < 20; ++i) append_any_block(run, any_material(random), {6, 6}, random);
  } else {
    for (std::size_t i = 0; i < 1000; ++i) {
      const Material& from = any_material(random);
      append_raw_pair(run, from.any_point(random), from.any_record(random), random, 1000);
    }
  }
  const std::uint64_t i = number % 49;
  run.patterns = {pattern(i / 7 + i), pattern(i), pattern(i / 7), pattern(i + 2 * (i / 7)),
                  random.bits()};
  return {run};
}

// A reset at any cycle: while records load, while the datapath fills, in full flow, in a stall.
std::vector<ElementRun> reset_in_midstream(std::uint64_t, Random& random) {
  ElementRun cut = any_flags(random, 300);
  cut.patterns = any_patterns(random);
  if (random.one_in(2)) cut.patterns.point = Pattern::kAlways;
  cut.cut = random.below(random.one_in(2) ? 60 : 500);
  ElementRun after;
  append_any_block(after, any_material(random), {20, 8}, random);
  append_any_block(after, any_material(random), {20, 8}, random);
  if (random.one_in(2)) after.patterns = any_patterns(random);
  return {cut, after};
}

}  // namespace

void append_block(ElementRun& run, std::span<const PointWords> points,
                  std::span<const RecordWords> records) {
  const auto count = static_cast<Word>(points.size());
  for (std::size_t r = 0; r < records.size(); ++r) {
    const bool first = r == 0, final = r + 1 == records.size();
    const Word beats = final ? count : std::max(count, kReadModifyWrite);
    run.records.push_back(records[r]);
    for (Word i = 0; i < beats; ++i) {
      const bool ends = i + 1 == beats;
      run.pairs.push_back({points[std::min(i, count - 1)], i, first, final, ends, ends && final});
    }
  }
}

const std::vector<ElementTest>& element_tests() {
  constexpr std::uint32_t kDevice = kDeviceSlotBits, kAny = kPairsSlotBits;
  static const std::vector<ElementTest> all = {
      raw_pairs("random bits", 300, random_bits),
      raw_pairs("near one", 1000, near_one),
      raw_pairs("special values", 1000, special_values),
      raw_pairs("huge and tiny", 500, huge_and_tiny),
      material_pairs("random soup", 500),
      material_pairs("bumpy sphere", 1000),
      material_pairs("slivers", 500),
      material_pairs("degenerate", 300),
      material_pairs("duplicated", 300),
      material_pairs("integer grid", 300),
      material_pairs("huge triangles", 300),
      material_pairs("far from the origin", 300),
      blocks("of a few points", kAny, 60, 3000, 30, {8, 8}),
      blocks("of many points", kAny, 12, 100, 1, {1u << kPointBits, 8}),
      blocks("with special values", kAny, 40, 400, 10, {30, 12, true}),
      blocks("on the device's element", kDevice, 40, 400, 10, {60, 12}),
      {"blocks: ties", kAny, 40, 1500, tied_blocks},
      {"streams: flags in any order", kAny, 60, 1000, free_flags},
      {"streams: idles and back-pressure", kDevice, 98, 980, crossed_patterns, false},
      {"streams: reset in mid-stream", kAny, 300, 5000, reset_in_midstream, false},
  };
  return all;
}

}  // namespace emax
