#include "host/tiles/normal_signs.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>
#include <utility>

namespace emax {
namespace {

// Sets of components, each with its sign relative to the root of its set.
class SignedSets {
 public:
  explicit SignedSets(std::size_t size) : parent_(size), sign_(size, 1) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::pair<std::size_t, float> root(std::size_t i) const {
    float sign = 1;
    for (; parent_[i] != i; i = parent_[i]) sign *= sign_[i];
    return {i, sign};
  }
  void join(std::size_t i, std::size_t j, float sign) {
    const auto [a, sign_a] = root(i);
    const auto [b, sign_b] = root(j);
    if (a == b) return;
    parent_[std::max(a, b)] = std::min(a, b);
    sign_[std::max(a, b)] = sign_a * sign_b * sign;
  }

 private:
  std::vector<std::size_t> parent_;
  std::vector<float> sign_;
};

struct Comparison {
  std::size_t a, b;
  std::int64_t agreement;  // points that agree less those that do not
};

// The first component of every part, as they are numbered through all parts, and their number.
std::vector<std::size_t> first_components(std::span<const PartNormals> parts) {
  std::vector<std::size_t> first = {0};
  for (const PartNormals& part : parts) first.push_back(first.back() + part.components.size());
  return first;
}

std::vector<Comparison> comparisons(std::span<const PartNormals> parts,
                                    std::span<const std::size_t> first) {
  std::map<std::pair<std::size_t, std::size_t>, std::int64_t> agreement;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (const BorderNormal& seen : parts[p].around) {
      const std::vector<BorderNormal>& own = parts[seen.owner].own;
      const auto at = std::ranges::lower_bound(own, seen.number, {}, &BorderNormal::number);
      if (at == own.end() || at->number != seen.number) continue;
      agreement[{first[p] + seen.component, first[seen.owner] + at->component}] +=
          seen.normal.dot(at->normal) < 0 ? -1 : 1;
    }
  }
  std::vector<Comparison> all;
  for (const auto& [pair, sum] : agreement) all.push_back({pair.first, pair.second, sum});
  std::ranges::stable_sort(all, [](const Comparison& x, const Comparison& y) {
    return std::abs(x.agreement) > std::abs(y.agreement);
  });
  return all;
}

// The sign that turns a set outward.
float outward(const Extremes& extremes) {
  float best = -1, sign = 1;
  for (const ExtremePoint& extreme : extremes) {
    if (std::abs(extreme.along) <= best) continue;
    best = std::abs(extreme.along);
    sign = extreme.along < 0 ? -1.0f : 1.0f;
  }
  return sign;
}

}  // namespace

void ExtremePoint::take(const ExtremePoint& other) {
  if (other.at > at || (other.at == at && other.number < number)) *this = other;
}

std::vector<std::vector<float>> consistent_signs(std::span<const PartNormals> parts) {
  const std::vector<std::size_t> first = first_components(parts);
  SignedSets sets(first.back());
  for (const Comparison& c : comparisons(parts, first)) {
    sets.join(c.a, c.b, c.agreement < 0 ? -1.0f : 1.0f);
  }
  std::map<std::size_t, Extremes> of_root;
  const auto each = [&](const auto& work) {
    for (std::size_t p = 0; p < parts.size(); ++p) {
      for (std::size_t c = 0; c < parts[p].components.size(); ++c) {
        const auto [root, sign] = sets.root(first[p] + c);
        work(p, c, root, sign);
      }
    }
  };
  each([&](std::size_t p, std::size_t c, std::size_t root, float sign) {
    for (std::size_t side = 0; side < 6; ++side) {
      ExtremePoint extreme = parts[p].components[c][side];
      extreme.along *= sign;
      of_root[root][side].take(extreme);
    }
  });
  std::vector<std::vector<float>> signs(parts.size());
  each([&](std::size_t p, std::size_t, std::size_t root, float sign) {
    signs[p].push_back(sign * outward(of_root.at(root)));
  });
  return signs;
}

}  // namespace emax
