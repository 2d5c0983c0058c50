#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "host/parameters/chain_parameters.h"
#include "host/parameters/decimation_bound.h"
#include "sw_model/base/mesh_view.h"

// The messages between a program and its workers, over any stream of bytes.
//
// A message is its length (8 bytes, little-endian, not counting themselves) and one CBOR map:
//   {"kind": "points", "points": P, "epsilon": number, "epsilon_back": number,
//    "reference_vertices": P, "reference_triangles": T,
//    "reference_method": s, "reference_parameters": {name: number}, "outliers": I}
//                                                                  to a worker, first and once
//   {"kind": "run", "ticket": n, "method": s, "decimator": s, "parameters": {name: number},
//    "rival": n, "threads": n}
//   {"kind": "part", "folder": s, "step": s, "part": n}   to a worker, in place of "points": a step
//   of a part of a cloud in files (host/tiles/part_plan.h), answered by "ready" or "unusable"
//   {"kind": "stop"}                                                 to a worker: end the
//   decimation
//   {"kind": "ready"}                                                from a worker, first and once
//   {"kind": "mesh", "ticket": n, "vertices": P, "triangles": T,
//    "reconstruction_triangles": n, "unmeshed_points": n,
//    "topology_difference": n, "back_distance": number, "reference_distance": number,
//    "stopped": boolean, "expected_triangles": n,
//    "seconds": [number, 4 of them]}                              the answer to "run", or:
//   {"kind": "failure", "ticket": n, "reason": "error" | "out of memory", "message": s}
//   {"kind": "unusable", "message": s}                               no evaluation can be made here
// P: byte string, three little-endian binary64 a point. T: byte string, three little-endian 32-bit
// indices a triangle. I: byte string of such indices. A worker answers one "run" before it reads
// the next. A worker that decimates ends the decimation on "stop" and answers with the mesh that it
// has. A worker that has answered ignores "stop".

namespace emax {

enum class FailureReason { kError, kOutOfMemory, kTimedOut, kCrashed, kGarbled };

// "error", "out of memory", "timed out", "crashed", "garbled"
std::string_view to_string(FailureReason reason);

struct Failure {
  FailureReason reason;
  std::string message;  // one line
};

struct PointsMessage {
  std::vector<Point> points;
  DecimationBound bound;
};
struct RunMessage {
  std::uint64_t ticket;
  ChainSettings settings;
  std::uint64_t rival = 0;    // triangles that the bounded decimator is to beat; 0: none
  std::uint64_t threads = 1;  // for it; a pool gives it no more than it has workers
};
struct PartMessage {
  std::string folder, step;
  std::uint64_t part;
};
struct StopMessage {};
struct ReadyMessage {};
struct MeshMessage {
  std::uint64_t ticket;
  ChainResult result;
};
struct FailureMessage {
  std::uint64_t ticket;
  Failure failure;
};
struct UnusableMessage {
  std::string message;
};

using Message = std::variant<PointsMessage, RunMessage, PartMessage, StopMessage, ReadyMessage,
                             MeshMessage, FailureMessage, UnusableMessage>;
using Bytes = std::vector<std::uint8_t>;

inline constexpr std::size_t kLengthBytes = 8;
// A longer message is invalid: 2^32 bytes hold 180 million vertices.
inline constexpr std::uint64_t kMaximumLength = std::uint64_t{1} << 32;

// The bytes of a message, its length first.
Bytes encode(const Message& message);

// The length of a message, which these eight bytes hold.
std::uint64_t announced_length(std::span<const std::uint8_t, kLengthBytes> bytes);

// Decodes a message without its length. Throws Error if it is not one of the above, a coordinate or
// distance is not finite, a distance is negative, or an index has no vertex.
Message decode(std::span<const std::uint8_t> body);

}  // namespace emax
