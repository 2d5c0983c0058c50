// The engine's search, kPacketPoints points at a time. Included once for each target.
#if defined(EMAX_HOST_PACKET_SEARCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef EMAX_HOST_PACKET_SEARCH_INL_H
#undef EMAX_HOST_PACKET_SEARCH_INL_H
#else
#define EMAX_HOST_PACKET_SEARCH_INL_H
#endif

#include "host/engine/candidates-inl.h"
#include "host/engine/engine_target.h"
#include "sw_model/base/float_bits.h"

HWY_BEFORE_NAMESPACE();
namespace emax {
namespace HWY_NAMESPACE {

constexpr std::uint32_t kAll = 0xffff;
constexpr float kNoLimit = -1.0f;  // every d^2 is above it

// Only a d^2 above this limit can change the maximum for a point of this packet: it is greater than
// the maximum, or equal to it with a lower index.
HWY_INLINE float limit_of(const RunningMaximum& worst, const Packet& packet) {
  if (!worst.is_set()) return kNoLimit;
  const EmaxResult r = worst.get();
  if (packet.index[0] > r.worst_point) return bits_float(r.squared_bits);
  return r.squared_bits == 0 ? kNoLimit : bits_float(r.squared_bits - 1);
}

// The limit that holds for every packet, whatever its indices.
HWY_INLINE float limit_of(const RunningMaximum& worst) {
  if (!worst.is_set()) return kNoLimit;
  const EmaxResult r = worst.get();
  return r.squared_bits == 0 ? kNoLimit : bits_float(r.squared_bits - 1);
}

// Triangles that settle points of a packet, gathered without a branch. The caller keeps the count
// in a register.
struct Witnesses {
  // Each entry settles a point that was open. add() also writes to the place behind the last entry.
  static constexpr std::size_t kRoom = kPacketPoints + 1;
  std::array<std::uint32_t, kRoom> leaves;
  std::array<std::uint32_t, kRoom> points;  // one bit each

  // Returns the new count.
  HWY_INLINE std::size_t add(std::size_t count, std::uint32_t leaf, std::uint32_t settled) {
    leaves[count] = leaf;
    points[count] = settled;
    return count + HWY_MIN(settled, 1u);  // GCC would make a branch of a comparison
  }
  // Replaces what `packet` had for these points.
  HWY_INLINE void keep(std::size_t count, SettledPacket& packet) const {
    const IndexTag d;
    const auto bits = hn::Shl(hn::Set(d, 1u), hn::Iota(d, 0u));
    for (std::size_t lane = 0; lane < kPacketPoints; lane += Floats::kCount) {
      auto kept = hn::LoadU(d, &packet.leaves[lane]);
      for (std::size_t i = 0; i < count; ++i) {
        const auto settled = hn::TestBit(hn::Set(d, points[i] >> lane), bits);
        kept = hn::IfThenElse(settled, hn::Set(d, leaves[i]), kept);
      }
      hn::StoreU(kept, d, &packet.leaves[lane]);
    }
  }
};

// Returns the points of packet i that triangles of an earlier mesh settle on this mesh, too. The
// packet's leaves become those of this mesh, kNoLeaf for the other points. `hint` becomes one of
// the leaves, if there is any.
HWY_INLINE std::uint32_t still_settled(const SearchJob& job, std::size_t i, float limit,
                                       std::uint32_t& hint) {
  const Settled& known = job.settled;
  SettledPacket& packet = known.packets[i];
  const bool is_now = packet.mesh == known.now;
  const bool serves = packet.squared_limit <= limit && (is_now || packet.mesh == known.before);
  packet.mesh = known.now;
  if (!serves) {
    packet.leaves.fill(kNoLeaf);
    return 0;
  }
  const IndexTag d;
  const auto none = hn::Set(d, kNoLeaf);
  std::uint32_t settled = 0;
  for (std::size_t lane = 0; lane < kPacketPoints; lane += Floats::kCount) {
    auto leaves = hn::LoadU(d, &packet.leaves[lane]);
    if (!is_now) {
      const auto last = hn::Set(d, static_cast<std::uint32_t>(known.carried.size() - 1));
      const auto index = hn::BitCast(hn::RebindToSigned<IndexTag>(), hn::Min(leaves, last));
      leaves = hn::GatherIndex(d, known.carried.data(), index);
      hn::StoreU(leaves, d, &packet.leaves[lane]);
    }
    settled |= bits_of(LaneMask<FloatTag>{hn::RebindMask(FloatTag(), hn::Ne(leaves, none))})
               << lane;
  }
  const std::uint32_t first = packet.leaves[hwy::Num0BitsBelowLS1Bit_Nonzero32(settled | 0x8000u)];
  if (first != kNoLeaf) hint = first;
  return settled;
}

// Packets of a supergroup whose balls a triangle settles, and that triangle.
class SettledBalls {
 public:
  HWY_INLINE void add(std::uint32_t packets, std::uint32_t leaf) {
    for (std::uint32_t more = packets & ~bits_; more != 0; more &= more - 1) {
      leaves_[hwy::Num0BitsBelowLS1Bit_Nonzero32(more)] = leaf;
    }
    bits_ |= packets;
  }
  HWY_INLINE bool has(std::size_t packet) const { return (bits_ >> packet & 1) != 0; }
  HWY_INLINE std::uint32_t leaf(std::size_t packet) const { return leaves_[packet]; }

 private:
  std::uint32_t bits_ = 0;
  std::array<std::uint32_t, kSupergroupPackets> leaves_;
};

struct Visit {
  float squared;
  std::uint32_t node;
  std::uint32_t level;
};

HWY_INLINE FloatBox box_of(const Packet& packet, std::uint32_t lanes) {
  const std::size_t first = hwy::Num0BitsBelowLS1Bit_Nonzero32(lanes);
  FloatBox box = {{packet.x[first], packet.y[first], packet.z[first]},
                  {packet.x[first], packet.y[first], packet.z[first]}};
  for (lanes &= lanes - 1; lanes != 0; lanes &= lanes - 1) {
    const std::size_t i = hwy::Num0BitsBelowLS1Bit_Nonzero32(lanes);
    const float p[3] = {packet.x[i], packet.y[i], packet.z[i]};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.lo[axis] = HWY_MIN(box.lo[axis], p[axis]);
      box.hi[axis] = HWY_MAX(box.hi[axis], p[axis]);
    }
  }
  return box;
}

HWY_INLINE float greatest(const std::array<float, kPacketPoints>& values, std::uint32_t lanes) {
  float most = 0;
  for (; lanes != 0; lanes &= lanes - 1) {
    most = HWY_MAX(most, values[hwy::Num0BitsBelowLS1Bit_Nonzero32(lanes)]);
  }
  return most;
}

// Searches best-first, beginning with the distances that the lanes have. It ends when every open
// lane is at or below the limit or has its true d^2, and returns the lanes above the limit.
// `last_met` becomes the record that was met last. The records that settle lanes are added to the
// witnesses.
[[gnu::flatten]] inline std::uint32_t search_tree(const TreeView& mesh, const Packet& packet,
                                                  PacketLanes& lanes, std::uint32_t open,
                                                  float limit, std::uint32_t& last_met,
                                                  Witnesses& witnesses, std::size_t& found) {
  if (open == 0) return 0;
  const BoxLanes box(box_of(packet, open));
  alignas(64) std::array<float, kPacketPoints> nearest;
  lanes.store(nearest);
  float bound = greatest(nearest, open) * kBoundSlack;

  // The stack holds a path of the tree and its siblings: at most levels * (kTreeWidth - 1) + 1.
  std::array<Visit, 8 * kTreeWidth> stack;
  std::size_t depth = 0;
  stack[depth++] = {0, 0, static_cast<std::uint32_t>(mesh.levels.size() - 1)};
  while (depth != 0) {
    const Visit visit = stack[--depth];
    if (visit.squared > bound) continue;
    alignas(64) std::array<float, kTreeWidth> squared;
    std::uint32_t children =
        box.within(mesh.levels[visit.level][visit.node], bound, squared.data());
    std::array<std::uint32_t, kTreeWidth> order;  // farthest first
    std::size_t count = 0;
    for (; children != 0; children &= children - 1) {
      const auto child = static_cast<std::uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(children));
      std::size_t place = count++;
      for (; place > 0 && squared[order[place - 1]] < squared[child]; --place) {
        order[place] = order[place - 1];
      }
      order[place] = child;
    }
    const std::uint32_t first = visit.node * kTreeWidth;
    if (visit.level > 0) {
      for (std::size_t i = 0; i < count; ++i) {
        stack[depth++] = {squared[order[i]], first + order[i], visit.level - 1};
      }
      continue;
    }
    while (count-- > 0 && squared[order[count]] <= bound) {
      last_met = first + order[count];
      lanes.meet(mesh.records[last_met]);
      const std::uint32_t left = open & lanes.above(limit);
      found = witnesses.add(found, last_met, open & ~left);
      open = left;
      if (open == 0) return 0;
      lanes.store(nearest);
      bound = greatest(nearest, open) * kBoundSlack;
    }
  }
  return open;
}

HWY_INLINE void raise(const SearchJob& job, const Packet& packet, const PacketLanes& lanes,
                      std::uint32_t open) {
  alignas(64) std::array<float, kPacketPoints> nearest;
  lanes.store(nearest);
  for (; open != 0; open &= open - 1) {
    const std::size_t i = hwy::Num0BitsBelowLS1Bit_Nonzero32(open);
    job.worst.raise({float_bits(nearest[i]), packet.index[i]});
  }
}

inline void search_packets(const SearchJob& job, std::span<const std::uint32_t> packets) {
  std::uint32_t hint = 0;
  Witnesses unused;
  for (const std::uint32_t p : packets) {
    std::size_t none = 0;
    const Packet& packet = job.cloud.packets[p];
    PacketLanes lanes(packet);
    raise(job, packet, lanes,
          search_tree(job.mesh, packet, lanes, kAll, kNoLimit, hint, unused, none));
  }
}

constexpr std::size_t kPrismTrial = 16;  // supergroups from one trial of prisms to the next
constexpr float kGuess = 2.0f;           // ratio of squared radii

// The packets of supergroup s.
struct PacketRange {
  std::size_t begin, end;
  HWY_INLINE PacketRange(const PacketView& cloud, std::size_t s)
      : begin(s * kSupergroupPackets),
        end(HWY_MIN(begin + kSupergroupPackets, cloud.packets.size())) {}
};

// Whether candidates are collected once for the whole supergroup. Where the radius exceeds the
// supergroup's size, the candidates would be nearly the same for each packet, and the last packet's
// triangle settles most points.
HWY_INLINE bool worth_collecting(const FloatBox& box, float squared_radius) {
  float side = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    side = HWY_MAX(side, box.hi[axis] - box.lo[axis]);
  }
  return squared_radius < side * side;
}

// Candidates are collected within this part of the limit, as a ratio of squares: most points are
// much nearer than the farthest. The other points are searched in the tree.
constexpr float kNear = 0x1p-4f;

// Prisms prove a limit lower by this ratio of squares, so that the proof also holds for a mesh with
// a lower maximum.
constexpr float kProven = 0.8f;

// At most this many points that the last mesh left open are searched directly in the tree.
constexpr std::size_t kFew = 4;

// A packet under search, in variables of the search so that they stay in registers.
struct OpenPacket {
  PacketLanes& lanes;
  std::uint32_t& open;  // its points that are above the limit so far
  std::size_t& found;   // how many triangles settled the others
  Witnesses& witnesses;

  HWY_INLINE void settle(std::uint32_t leaf, std::uint32_t left) const {
    found = witnesses.add(found, leaf, open & ~left);
    open = left;
  }
  HWY_INLINE void meet(const SearchJob& job, std::uint32_t leaf, float limit) const {
    lanes.meet(job.mesh.records[leaf]);
    settle(leaf, open & lanes.above(limit));
  }
  // Only whether points lie in the triangle's prism, which is cheaper than their distance.
  HWY_INLINE void meet(const SearchJob& job, std::uint32_t leaf, const Prism& prism) const {
    settle(leaf, open & ~lanes.inside(job.mesh.records[leaf], prism));
  }
  // Points that stay above the limit raise the maximum.
  HWY_INLINE void search(const SearchJob& job, std::size_t i, float limit,
                         std::uint32_t& hint) const {
    const Packet& packet = job.cloud.packets[i];
    std::size_t in_tree = found;  // so that `found` stays in a register
    open = search_tree(job.mesh, packet, lanes, open, limit, hint, witnesses, in_tree);
    found = in_tree;
    if (open == 0) return;
    raise(job, packet, lanes, open);
    job.raised.push_back(static_cast<std::uint32_t>(i));
  }
};

// Candidates for the packets of a supergroup, collected for the first packet that asks.
class SupergroupCandidates {
 public:
  HWY_INLINE void begin() { collected_ = false; }
  HWY_INLINE void collect(const SearchJob& job, const FloatBox& box, float limit) {
    radius_ = limit * kNear;
    collected_ = job.strategy != Strategy::kBestFirst &&
                 (job.strategy == Strategy::kPackets || worth_collecting(box, limit)) &&
                 candidates_.collect(job.mesh, box, radius_);
  }
  HWY_INLINE std::size_t choose(const FloatBox& packet) {
    return collected_ ? candidates_.choose(packet, radius_, chosen_) : 0;
  }
  HWY_INLINE std::uint32_t operator[](std::size_t i) const { return chosen_[i]; }

 private:
  Candidates candidates_;
  Candidates::List chosen_;
  float radius_ = 0;  // squared
  bool collected_ = false;
};

[[gnu::flatten]] inline void search_supergroups(const SearchJob& job, std::size_t first,
                                                std::size_t last) {
  SupergroupCandidates candidates;
  Witnesses witnesses;
  std::uint32_t hint = 0;
  std::size_t inside_prisms = kPacketPoints, in_packets = 1;  // of the previous supergroup
  for (std::size_t s = first; s < last; ++s) {
    if (job.worst.is_set() && job.worst.get().squared_bits > job.enough) return;
    const PacketRange range(job.cloud, s);
    candidates.begin();
    // Few points lie in the prisms of slivers. Prisms are then tried only for every kPrismTrial-th
    // supergroup.
    const bool use_prisms = s % kPrismTrial == 0 || 2 * inside_prisms >= in_packets * kPacketPoints;
    inside_prisms = in_packets = 0;
    // Where the maximum is large relative to packets, one triangle settles many of them at once.
    const float ball_limit = limit_of(job.worst) * kProven;
    const BallLanes balls(job.cloud.balls[s], allowed_distance(ball_limit, job.mesh.reach));
    SettledBalls within;
    bool new_hint = balls.smaller() != 0;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      SettledPacket& settled = job.settled.packets[i];
      const float limit = limit_of(job.worst, job.cloud.packets[i]);
      std::uint32_t open = kAll & ~still_settled(job, i, limit, hint);
      if (open == 0) continue;
      if (new_hint) within.add(balls.within(job.mesh.records[hint]), hint);
      new_hint = false;
      if (within.has(i - range.begin)) {
        settled = {ball_limit, job.settled.now, {}};
        settled.leaves.fill(within.leaf(i - range.begin));
        continue;
      }
      const float proven_before = open != kAll ? settled.squared_limit : 0.0f;
      float proven = limit;
      PacketLanes lanes(job.cloud.packets[i]);
      std::size_t found = 0;
      const OpenPacket points = {lanes, open, found, witnesses};
      const bool few = hwy::PopCount(open) <= kFew;
      if (!few && in_packets++ == 0) candidates.collect(job, job.cloud.supergroups[s], limit);
      std::size_t count = 0;
      if (use_prisms && !few) {
        const Prism prism(limit * kProven, job.mesh.reach);
        points.meet(job, hint, prism);
        if (open != 0) count = candidates.choose(job.cloud.boxes[i]);
        for (std::size_t t = 0; open != 0 && t < count; ++t) points.meet(job, candidates[t], prism);
        inside_prisms += kPacketPoints - hwy::PopCount(open);
        if (open == 0) proven = HWY_MAX(proven_before, limit * kProven);
      } else {
        points.meet(job, hint, limit);
        if (open != 0 && !few) count = candidates.choose(job.cloud.boxes[i]);
      }
      for (std::size_t t = 0; open != 0 && t < count; ++t) points.meet(job, candidates[t], limit);
      if (open != 0) points.search(job, i, limit, hint);
      if (found != 0) hint = witnesses.leaves[found - 1];
      witnesses.keep(found, settled);
      settled.squared_limit = proven;
      new_hint = found != 0 && balls.smaller() != 0;
    }
  }
}

// The radius for a supergroup is a guess from the previous one, within which most points will be.
// Points beyond it are searched in the tree.
[[gnu::flatten]] inline void nearest(const SearchJob& job, std::size_t first, std::size_t last,
                                     std::span<std::uint32_t> squared_bits) {
  Candidates candidates;
  Witnesses unused;
  Candidates::List chosen;
  std::uint32_t hint = 0;
  float radius = 0;
  for (std::size_t s = first; s < last; ++s) {
    const PacketRange range(job.cloud, s);
    const FloatBox& box = job.cloud.supergroups[s];
    const bool collected = job.strategy != Strategy::kBestFirst && worth_collecting(box, radius) &&
                           candidates.collect(job.mesh, box, radius);
    float greatest_squared = 0;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const Packet& packet = job.cloud.packets[i];
      PacketLanes lanes(packet);
      alignas(64) std::array<float, kPacketPoints> squared;
      for (std::size_t k = 0; k < kPacketPoints; ++k) {
        squared[k] = bits_float(squared_bits[packet.index[k]]);
      }
      lanes.load(squared);
      std::uint32_t open = kAll;
      lanes.meet(job.mesh.records[hint]);
      if (collected) {
        const std::size_t count = candidates.choose(job.cloud.boxes[i], radius, chosen);
        for (std::size_t t = 0; t < count; ++t) lanes.meet(job.mesh.records[chosen[t]]);
        open = lanes.above(radius * (2 - kBoundSlack));
      }
      std::size_t none = 0;
      search_tree(job.mesh, packet, lanes, open, kNoLimit, hint, unused, none);
      lanes.store(squared);
      greatest_squared = HWY_MAX(greatest_squared, greatest(squared, kAll));
      for (std::size_t k = 0; k < kPacketPoints; ++k) {
        squared_bits[packet.index[k]] = float_bits(squared[k]);
      }
    }
    radius = kGuess * greatest_squared;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace emax
HWY_AFTER_NAMESPACE();

#endif
