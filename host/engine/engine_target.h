#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "host/engine/packets.h"
#include "sw_model/base/morton.h"
#include "sw_model/model/emax_model.h"
#include "sw_model/model/normalization.h"

namespace emax {

// The greatest distance so far, shared by threads: d^2 bits and the lowest index that has them, in
// one word that only grows. Its final value does not depend on the order in which threads raise it.
class RunningMaximum {
 public:
  static std::uint64_t key(const EmaxResult& r) {
    return (std::uint64_t{r.squared_bits} + 1) << 32 | ~r.worst_point;
  }
  void raise(const EmaxResult& r) {
    std::uint64_t now = key_.load(std::memory_order_relaxed);
    while (now < key(r) && !key_.compare_exchange_weak(now, key(r), std::memory_order_relaxed)) {
    }
  }
  bool is_set() const { return load() != 0; }
  EmaxResult get() const {
    const std::uint64_t now = load();
    return {static_cast<std::uint32_t>((now >> 32) - 1), ~static_cast<std::uint32_t>(now)};
  }

 private:
  std::uint64_t load() const { return key_.load(std::memory_order_relaxed); }
  std::atomic<std::uint64_t> key_ = 0;
};

// How candidates for a packet are found. All strategies give the same answers.
enum class Strategy {
  kAutomatic,  // by the radius relative to the supergroup's size
  kPackets,    // collected for a supergroup and chosen for each of its packets
  kBestFirst,  // from the tree's root for each packet; the last packet's triangle is the hint
};

// What earlier meshes settled of a cloud's packets.
struct Settled {
  std::span<SettledPacket> packets;   // of the cloud
  std::uint32_t now = 0, before = 0;  // the meshes' numbers
  // Maps each leaf of `before` to the equal leaf of `now`, or to kNoLeaf where there is none. The
  // array ends with an extra kNoLeaf.
  std::span<const std::uint32_t> carried;
};

struct SearchJob {
  PacketView cloud;
  TreeView mesh;
  Strategy strategy;
  RunningMaximum& worst;
  std::uint32_t enough;                // d^2 bits: the search ends when the maximum exceeds them
  std::vector<std::uint32_t>& raised;  // packets that raised the maximum are appended
  Settled settled;
};

// The engine's inner loops for one SIMD instruction set. Every target gives the same bits.
struct EngineTarget {
  std::string_view name;

  // Makes the triangles' records and the blocks of their boxes; returns their reach. The vertices
  // are normalised and in range. O(n), about 100 operations on doubles for each triangle.
  float (*make_leaves)(std::span<const NormalizedVertex> vertices,
                       std::span<const Triangle> corners, std::span<const MortonKey> keys,
                       std::span<TriangleRecord<float>> records, std::span<BoxBlock> blocks);
  void (*make_level)(std::span<const BoxBlock> below, std::span<BoxBlock> level);

  // Raises the maximum by the exact d^2 of every point of these packets (best-first).
  void (*search_packets)(const SearchJob& job, std::span<const std::uint32_t> packets);
  // Raises the maximum by all points of a range of supergroups. Points that cannot raise it are
  // settled without their exact d^2.
  void (*search_supergroups)(const SearchJob& job, std::size_t first, std::size_t last);
  // Lowers the d^2 bits of every point of a range of supergroups, by point index, to those of this
  // mesh.
  void (*nearest)(const SearchJob& job, std::size_t first, std::size_t last,
                  std::span<std::uint32_t> squared_bits);
};

// The targets that this processor runs, best first; the last uses no SIMD.
std::span<const EngineTarget> engine_targets();

}  // namespace emax
