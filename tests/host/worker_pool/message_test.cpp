#include "host/worker_pool/message.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

#include "sw_model/base/error.h"
#include "tests/host/support/surface_clouds.h"

namespace emax::test {
namespace {

std::span<const std::uint8_t> body(const Bytes& bytes) {
  return std::span(bytes).subspan(kLengthBytes);
}

template <typename T>
T round_trip(const T& message) {
  const Bytes bytes = encode(message);
  EXPECT_EQ(announced_length(std::span(bytes).template first<kLengthBytes>()),
            bytes.size() - kLengthBytes);
  return std::get<T>(decode(body(bytes)));
}

MeshMessage tetrahedron() {
  return {7,
          {{{{0, 0, 0}, {1e7 + 1e-3, 0, 0}, {0, 0.1, 0}, {0, 0, -0.0}},
            {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}},
           4,
           1,
           0,
           0,
           {}}};
}

TEST(Message, CarriesEveryBitOfPoints) {
  std::vector<Point> points = sphere_cloud(50);
  points.push_back({5e-324, -0.0, 1.7976931348623157e308});
  const PointsMessage got = round_trip(PointsMessage{points, {}});
  EXPECT_EQ(got.points, points);
  EXPECT_TRUE(std::signbit(got.points.back().y()));
  EXPECT_EQ(got.bound.epsilon, 0);
}

TEST(Message, CarriesTheBoundOfTheDecimator) {
  const DecimationBound bound = {0.1,
                                 1e-300,
                                 tetrahedron().result.mesh,
                                 {3, 7, ~0u},
                                 {"gp3", ParameterValues({{"a", 0.1}, {"b", -0.0}})}};
  const DecimationBound got = round_trip(PointsMessage{sphere_cloud(5), bound}).bound;
  EXPECT_EQ(got.epsilon, bound.epsilon);
  EXPECT_EQ(got.epsilon_back, bound.epsilon_back);
  EXPECT_TRUE(same_bytes(got.reference, bound.reference));
  EXPECT_EQ(got.outliers, bound.outliers);
  EXPECT_EQ(got.made_by, bound.made_by);
}

TEST(Message, CarriesSettings) {
  const RunMessage sent{
      ~std::uint64_t{0},
      {"gp3", "schroeder", ParameterValues({{"a", 0.1}, {"b", 3}, {"c", 1e-300}, {"d", -0.0}})},
      ~std::uint64_t{1},
      7};
  const RunMessage got = round_trip(sent);
  EXPECT_EQ(got.ticket, sent.ticket);
  EXPECT_EQ(got.settings.method, "gp3");
  EXPECT_EQ(got.settings.decimator, "schroeder");
  EXPECT_EQ(got.settings.parameters, sent.settings.parameters);
  EXPECT_EQ(got.rival, sent.rival);
  EXPECT_EQ(got.threads, sent.threads);
}

TEST(Message, CarriesAMesh) {
  MeshMessage sent = tetrahedron();
  sent.result.topology_difference = 7;
  sent.result.back_distance = 0.1;
  sent.result.reference_distance = 0.2;
  sent.result.stopped = true;
  sent.result.expected_triangles = 5;
  sent.result.seconds = {1, 2, 3, 4.5};
  const MeshMessage got = round_trip(sent);
  EXPECT_EQ(got.result.topology_difference, 7u);
  EXPECT_EQ(got.result.back_distance, 0.1);
  EXPECT_EQ(got.result.reference_distance, 0.2);
  EXPECT_TRUE(got.result.stopped);
  EXPECT_EQ(got.result.expected_triangles, 5u);
  EXPECT_FALSE(round_trip(tetrahedron()).result.stopped);
  EXPECT_EQ(got.result.seconds.prepare, 2);
  EXPECT_EQ(got.result.seconds.sum(), 10.5);
  EXPECT_EQ(got.ticket, 7u);
  EXPECT_TRUE(same_bytes(got.result.mesh, sent.result.mesh));
  EXPECT_EQ(got.result.reconstruction_triangles, 4u);
  EXPECT_EQ(got.result.unmeshed_points, 1u);
}

TEST(Message, CarriesFailures) {
  for (const auto reason : {FailureReason::kError, FailureReason::kOutOfMemory}) {
    const FailureMessage got = round_trip(FailureMessage{3, {reason, "why"}});
    EXPECT_EQ(got.ticket, 3u);
    EXPECT_EQ(got.failure.reason, reason);
    EXPECT_EQ(got.failure.message, "why");
  }
  EXPECT_EQ(round_trip(UnusableMessage{"bad"}).message, "bad");
  round_trip(ReadyMessage{});
  round_trip(StopMessage{});
  const PartMessage part = round_trip(PartMessage{"a folder", "look", 7});
  EXPECT_EQ(part.folder, "a folder");
  EXPECT_EQ(part.step, "look");
  EXPECT_EQ(part.part, 7u);
}

TEST(Message, RefusesEveryTruncation) {
  const Bytes bytes = encode(tetrahedron());
  for (std::size_t length = 0; length < bytes.size() - kLengthBytes; ++length) {
    EXPECT_THROW(decode(body(bytes).first(length)), Error) << length;
  }
}

// No byte of garbage may do more than throw Error; what decodes nevertheless is a sound mesh.
TEST(Message, SurvivesEveryChangedByte) {
  const Bytes bytes = encode(tetrahedron());
  std::size_t refused = 0;
  for (std::size_t at = kLengthBytes; at < bytes.size(); ++at) {
    for (const std::uint8_t change : Bytes{0x01, 0x20, 0x80, 0xff}) {
      Bytes changed = bytes;
      changed[at] = static_cast<std::uint8_t>(changed[at] ^ change);
      try {
        const Message message = decode(body(changed));
        if (const auto* mesh = std::get_if<MeshMessage>(&message)) {
          for (const Triangle& t : mesh->result.mesh.triangles) {
            for (const std::uint32_t v : t) ASSERT_LT(v, mesh->result.mesh.vertices.size());
          }
        }
      } catch (const Error&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, bytes.size() / 2);
}

TEST(Message, RefusesWhatIsNestedTooDeeply) {
  // Lists of one list, maps of one map, strings in strings of unknown length, tags.
  Bytes maps;
  for (int i = 0; i < 500'000; ++i) maps.insert(maps.end(), {0xa1, 0x60});
  for (const Bytes& nested :
       {Bytes(1'000'000, 0x81), Bytes(1'000'000, 0x9f), maps, Bytes(1'000'000, 0x5f),
        Bytes(1'000'000, 0x7f), Bytes(1'000'000, 0xc0)}) {
    EXPECT_THROW(decode(nested), Error);
  }
}

TEST(Message, RefusesDistancesThatAreNone) {
  for (const double distance :
       {-1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    for (double ChainResult::*member :
         {&ChainResult::back_distance, &ChainResult::reference_distance}) {
      MeshMessage message = tetrahedron();
      message.result.*member = distance;
      EXPECT_THROW(decode(body(encode(message))), Error) << distance;
    }
  }
}

// The value behind the first key of that name changed to another of one byte.
TEST(Message, RefusesCountsAndReasonsThatAreNone) {
  const auto with = [](Bytes bytes, const std::string& key, std::uint8_t value) {
    const auto at = std::search(bytes.begin(), bytes.end(), key.begin(), key.end());
    EXPECT_NE(at, bytes.end()) << key;
    *(at + static_cast<std::ptrdiff_t>(key.size())) = value;
    return bytes;
  };
  constexpr std::uint8_t kSeven = 0x07, kMinusEight = 0x27, kNull = 0xf6;
  for (const char* key : {"ticket", "reconstruction_triangles", "unmeshed_points"}) {
    const Bytes bytes = encode(tetrahedron());
    EXPECT_NO_THROW(decode(body(with(bytes, key, kSeven)))) << key;
    EXPECT_THROW(decode(body(with(bytes, key, kMinusEight))), Error) << key;
    EXPECT_THROW(decode(body(with(bytes, key, kNull))), Error) << key;
  }
  for (const FailureReason reason :
       {FailureReason::kTimedOut, FailureReason::kCrashed, FailureReason::kGarbled}) {
    EXPECT_THROW(decode(body(encode(FailureMessage{7, {reason, "why"}}))), Error);
  }
}

TEST(Message, RefusesIndicesWithoutVertexAndPointsThatAreNotFinite) {
  MeshMessage message = tetrahedron();
  message.result.mesh.triangles[2][1] = 4;
  EXPECT_THROW(decode(body(encode(message))), Error);
  message = tetrahedron();
  message.result.mesh.vertices[1].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(decode(body(encode(message))), Error);
}

}  // namespace
}  // namespace emax::test
