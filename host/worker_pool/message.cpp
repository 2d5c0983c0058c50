#include "host/worker_pool/message.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "host/worker_pool/packed.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "messages are little-endian");
static_assert(sizeof(Point) == 3 * sizeof(double), "points are sent as they lie in memory");
static_assert(sizeof(Triangle) == 3 * sizeof(std::uint32_t),
              "triangles are sent as they lie in memory");

std::vector<Point> points_from_binary(const json& value) {
  auto points = unpacked<Point>(value);
  for (const Point& p : points) {
    if (!p.allFinite()) throw Error("a coordinate is not finite");
  }
  return points;
}

json to_json(const PointsMessage& m) {
  return {{"kind", "points"},
          {"points", packed(m.points)},
          {"epsilon", m.bound.epsilon},
          {"epsilon_back", m.bound.epsilon_back},
          {"reference_vertices", packed(m.bound.reference.vertices)},
          {"reference_triangles", packed(m.bound.reference.triangles)},
          {"reference_method", m.bound.made_by.first},
          {"reference_parameters", m.bound.made_by.second.by_name()},
          {"outliers", packed(m.bound.outliers)}};
}

json to_json(const RunMessage& m) {
  return {{"kind", "run"},
          {"ticket", m.ticket},
          {"method", m.settings.method},
          {"decimator", m.settings.decimator},
          {"parameters", m.settings.parameters.by_name()},
          {"rival", m.rival},
          {"threads", m.threads}};
}

json to_json(const PartMessage& m) {
  return {{"kind", "part"}, {"folder", m.folder}, {"step", m.step}, {"part", m.part}};
}

json to_json(const StopMessage&) { return {{"kind", "stop"}}; }

json to_json(const ReadyMessage&) { return {{"kind", "ready"}}; }

json to_json(const MeshMessage& m) {
  const StageSeconds& t = m.result.seconds;
  return {{"kind", "mesh"},
          {"ticket", m.ticket},
          {"vertices", packed(m.result.mesh.vertices)},
          {"triangles", packed(m.result.mesh.triangles)},
          {"reconstruction_triangles", m.result.reconstruction_triangles},
          {"unmeshed_points", m.result.unmeshed_points},
          {"topology_difference", m.result.topology_difference},
          {"back_distance", m.result.back_distance},
          {"reference_distance", m.result.reference_distance},
          {"stopped", m.result.stopped},
          {"expected_triangles", m.result.expected_triangles},
          {"seconds", {t.reconstruct, t.prepare, t.decimate, t.check}}};
}

json to_json(const FailureMessage& m) {
  return {{"kind", "failure"},
          {"ticket", m.ticket},
          {"reason", to_string(m.failure.reason)},
          {"message", m.failure.message}};
}

json to_json(const UnusableMessage& m) { return {{"kind", "unusable"}, {"message", m.message}}; }

TriangleMesh mesh_from_binary(const json& vertices, const json& triangles) {
  TriangleMesh mesh{points_from_binary(vertices), unpacked<Triangle>(triangles)};
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      if (v >= mesh.vertices.size() && !EMAX_FAULT(kTrustsIndices)) {
        throw Error("a triangle has an index without a vertex");
      }
    }
  }
  return mesh;
}

std::uint64_t count_from(const json& j) {
  if (!j.is_number_unsigned()) throw Error("a count is no whole number");
  return j;
}

double distance_from(const json& j) {
  const double distance = j;
  if (!(distance >= 0) || std::isinf(distance)) throw Error("a distance is negative or not finite");
  return distance;
}

Message points_from_json(const json& j) {
  PointsMessage m{points_from_binary(j.at("points")), {}};
  j.at("epsilon").get_to(m.bound.epsilon);
  j.at("epsilon_back").get_to(m.bound.epsilon_back);
  m.bound.reference = mesh_from_binary(j.at("reference_vertices"), j.at("reference_triangles"));
  m.bound.made_by = {j.at("reference_method"),
                     ParameterValues(j.at("reference_parameters").get<ParameterValues::ByName>())};
  m.bound.outliers = unpacked<std::uint32_t>(j.at("outliers"));
  return m;
}

Message mesh_from_json(const json& j) {
  MeshMessage m{count_from(j.at("ticket")), {}};
  m.result.mesh = mesh_from_binary(j.at("vertices"), j.at("triangles"));
  m.result.reconstruction_triangles = count_from(j.at("reconstruction_triangles"));
  m.result.unmeshed_points = count_from(j.at("unmeshed_points"));
  m.result.topology_difference = count_from(j.at("topology_difference"));
  m.result.back_distance = distance_from(j.at("back_distance"));
  m.result.reference_distance = distance_from(j.at("reference_distance"));
  j.at("stopped").get_to(m.result.stopped);
  m.result.expected_triangles = count_from(j.at("expected_triangles"));
  const json& seconds = j.at("seconds");
  m.result.seconds = {seconds.at(0), seconds.at(1), seconds.at(2), seconds.at(3)};
  return m;
}

// Whether the items are CBOR as encode() writes it: with known lengths and without tags, and with
// no nesting deeper than a map or list in the message's map. The parser recurses for anything else,
// so invalid bytes could exhaust the stack.
bool is_shallow(std::span<const std::uint8_t> body) {
  constexpr std::size_t kDeepest = 2;
  constexpr unsigned kBytes = 2, kText = 3, kList = 4, kMap = 5, kTag = 6;
  std::vector<std::uint64_t> left = {1};  // items that are left in each enclosing item
  for (std::size_t at = 0; !left.empty();) {
    if (at == body.size()) return false;
    const unsigned kind = body[at] >> 5, size = body[at] & 31;
    ++at;
    if (size > 27 || kind == kTag) return false;
    const std::size_t bytes = size < 24 ? 0 : std::size_t{1} << (size - 24);
    if (bytes > body.size() - at) return false;
    std::uint64_t value = size;
    if (bytes > 0) value = 0;
    for (std::size_t i = 0; i < bytes; ++i) value = value << 8 | body[at++];
    --left.back();
    if (kind == kBytes || kind == kText) {
      if (value > body.size() - at) return false;
      at += value;
    } else if (kind == kList || kind == kMap) {
      if (left.size() > kDeepest || value > body.size()) return false;
      left.push_back(kind == kMap ? 2 * value : value);
    }
    while (!left.empty() && left.back() == 0) left.pop_back();
  }
  return true;
}

Message from_json(const json& j) {
  const std::string kind = j.at("kind");
  if (kind == "points") return points_from_json(j);
  if (kind == "run") {
    return RunMessage{count_from(j.at("ticket")),
                      {j.at("method"), j.at("decimator"),
                       ParameterValues(j.at("parameters").get<ParameterValues::ByName>())},
                      count_from(j.at("rival")),
                      count_from(j.at("threads"))};
  }
  if (kind == "part") return PartMessage{j.at("folder"), j.at("step"), count_from(j.at("part"))};
  if (kind == "stop") return StopMessage{};
  if (kind == "ready") return ReadyMessage{};
  if (kind == "mesh") return mesh_from_json(j);
  if (kind == "failure") {
    for (const FailureReason reason : {FailureReason::kError, FailureReason::kOutOfMemory}) {
      if (j.at("reason") != to_string(reason)) continue;
      return FailureMessage{count_from(j.at("ticket")), {reason, j.at("message")}};
    }
    throw Error("a failure without a known reason");
  }
  if (kind == "unusable") return UnusableMessage{j.at("message")};
  throw Error("unknown kind of message '" + kind + "'");
}

}  // namespace

std::string_view to_string(FailureReason reason) {
  switch (reason) {
    case FailureReason::kError:
      return "error";
    case FailureReason::kOutOfMemory:
      return "out of memory";
    case FailureReason::kTimedOut:
      return "timed out";
    case FailureReason::kCrashed:
      return "crashed";
    case FailureReason::kGarbled:
      return "garbled";
  }
  return "";
}

Bytes encode(const Message& message) {
  Bytes bytes(kLengthBytes);
  json::to_cbor(std::visit([](const auto& m) { return to_json(m); }, message), bytes);
  const std::uint64_t length = bytes.size() - kLengthBytes;
  std::memcpy(bytes.data(), &length, kLengthBytes);
  return bytes;
}

std::uint64_t announced_length(std::span<const std::uint8_t, kLengthBytes> bytes) {
  std::uint64_t length;
  std::memcpy(&length, bytes.data(), kLengthBytes);
  return length;
}

Message decode(std::span<const std::uint8_t> body) {
  if (!is_shallow(body)) throw Error("not a message: broken, or nested too deeply");
  try {
    return from_json(json::from_cbor(body.begin(), body.end()));
  } catch (const json::exception& e) {
    throw Error(std::string("not a message: ") + e.what());
  }
}

}  // namespace emax
