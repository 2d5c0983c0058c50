#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "hls/kernel/triangle_record.h"

namespace emax {

// The memory layout of cloud and mesh for the engine's SIMD code.

constexpr std::size_t kPacketPoints = 16;
constexpr std::size_t kSupergroupPackets = 8;
constexpr std::size_t kTreeWidth = 16;

// Neighbouring points, their indices ascending; a packet that is not full repeats its last point.
struct alignas(64) Packet {
  std::array<float, kPacketPoints> x, y, z;
  std::array<std::uint32_t, kPacketPoints> index;
};

// A ball around the points of each packet of a supergroup; infinite where there is no packet.
struct alignas(32) PacketBalls {
  std::array<float, kSupergroupPackets> x, y, z, radius;
};

struct FloatBox {
  std::array<float, 3> lo, hi;
};

// A vector's worth of doubles, the last one unused.
struct alignas(32) NormalizedVertex {
  std::array<double, 4> at;
};

constexpr std::uint32_t kNoLeaf = 0xffffffffu;

// The triangles that settled a packet on a mesh: for each point a triangle within
// sqrt(squared_limit) of it, or kNoLeaf. They serve for every mesh that has the same triangle.
struct SettledPacket {
  float squared_limit = std::numeric_limits<float>::infinity();  // infinity: nothing is settled
  std::uint32_t mesh = 0;                                        // the mesh's number
  std::array<std::uint32_t, kPacketPoints> leaves;
};

// The boxes of a tree node's children; the boxes behind the last child are empty (infinitely far).
// Each box is enlarged by the part of the kernel's error that does not depend on the point
// (docs/numerics.md, "Lower bounds in binary32").
struct alignas(64) BoxBlock {
  std::array<std::array<float, kTreeWidth>, 3> lo, hi;
};

struct PacketView {
  std::span<const Packet> packets;
  std::span<const FloatBox> boxes;        // of packets
  std::span<const FloatBox> supergroups;  // of kSupergroupPackets packets each
  std::span<const PacketBalls> balls;     // of supergroups
};

// Records in the order of the leaves. Child c of block b of a level is block b * kTreeWidth + c of
// the level below; on level 0 the child is a record. The last level is one block.
struct TreeView {
  std::span<const TriangleRecord<float>> records;
  float reach;  // at least the greatest |V1| + longest edge of a triangle
  std::span<const std::span<const BoxBlock>> levels;
};

}  // namespace emax
