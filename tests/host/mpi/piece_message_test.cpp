#include "host/mpi/piece_message.h"

#include <gtest/gtest.h>

#include "host/measure/point_distances.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

void expect_equal(const CertificatePart& a, const CertificatePart& b) {
  EXPECT_EQ(a.upper, b.upper);
  EXPECT_EQ(a.worst_point, b.worst_point);
  EXPECT_EQ(a.at, b.at);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.excluded, b.excluded);
}

TEST(PieceMessage, CarriesATask) {
  PiecesTask sent;
  sent.cloud.path = "/a folder/\xff.las";  // no UTF-8
  sent.cloud.reading = {true, {7, 18}};
  sent.cloud.bytes = 1ull << 40;
  sent.cloud.piece_points = 16384;
  sent.cloud.is_complete = true;
  sent.cloud.bounds = {{-0.1, -0.0, 1e-300}, {1, 2, 3}};
  sent.cloud.marks = {{1, 2, 3}, {4, ~0ull, 6}};
  sent.files = {"mesh.ply", "reference.ply", true};
  sent.mesh_checksum = ~0u;
  sent.reference_checksum = 5;
  sent.brute_force = true;
  sent.question = {true, true, false, 0.1, 1e-17, 9, {3, ~0u}};
  sent.share = {2, 5, 11};
  const PiecesTask got = decode_pieces_task(encode(sent));
  EXPECT_EQ(got.cloud.path, sent.cloud.path);
  EXPECT_EQ(got.cloud.reading, sent.cloud.reading);
  EXPECT_EQ(got.cloud.bytes, sent.cloud.bytes);
  EXPECT_EQ(got.cloud.piece_points, sent.cloud.piece_points);
  EXPECT_EQ(got.cloud.is_complete, sent.cloud.is_complete);
  EXPECT_EQ(got.cloud.bounds.lower, sent.cloud.bounds.lower);
  EXPECT_EQ(got.cloud.bounds.upper, sent.cloud.bounds.upper);
  EXPECT_EQ(got.cloud.marks, sent.cloud.marks);
  EXPECT_EQ(got.files.mesh, sent.files.mesh);
  EXPECT_EQ(got.files.reference, sent.files.reference);
  EXPECT_EQ(got.files.used_vertices_alone, sent.files.used_vertices_alone);
  EXPECT_EQ(got.mesh_checksum, sent.mesh_checksum);
  EXPECT_EQ(got.reference_checksum, sent.reference_checksum);
  EXPECT_EQ(got.brute_force, sent.brute_force);
  EXPECT_EQ(got.question.worst, sent.question.worst);
  EXPECT_EQ(got.question.distances, sent.question.distances);
  EXPECT_EQ(got.question.certify, sent.question.certify);
  EXPECT_EQ(got.question.limit, sent.question.limit);
  EXPECT_EQ(got.question.margin, sent.question.margin);
  EXPECT_EQ(got.question.farthest, sent.question.farthest);
  EXPECT_EQ(got.question.excluded, sent.question.excluded);
  EXPECT_EQ(got.share.first, sent.share.first);
  EXPECT_EQ(got.share.last, sent.share.last);
  EXPECT_EQ(got.share.of, sent.share.of);
}

TEST(PieceMessage, CarriesTheFindingsOfAPiece) {
  const Normalization normalization = {{1, 2, 3}, 0.25};
  PieceFindings sent;
  sent.first = 1ull << 33;
  sent.points = 3;
  sent.worst = {0x3f000000, ~0u};
  sent.squared_bits = {0x3e000000, 0x3f000000, 0};
  for (const std::uint32_t bits : sent.squared_bits) {
    sent.distances.push_back(in_file_units(normalization, bits));
  }
  sent.distances[1] = 0.1;  // an exact one
  sent.first_number = 7;
  sent.listed_numbers = {7, 9, ~0u};
  sent.farthest = {{0.1, 9, 1, {1, -0.0, 3}}, {0.05, 7, 0, {4, 5, 6}}};
  sent.seconds = 0.3;
  const PieceFindings got = decode_piece_findings(encode(sent, normalization), normalization);
  EXPECT_EQ(got.first, sent.first);
  EXPECT_EQ(got.points, sent.points);
  EXPECT_EQ(got.worst, sent.worst);
  EXPECT_EQ(got.squared_bits, sent.squared_bits);
  EXPECT_EQ(got.distances, sent.distances);
  EXPECT_EQ(got.first_number, sent.first_number);
  EXPECT_EQ(got.listed_numbers, sent.listed_numbers);
  ASSERT_EQ(got.farthest.size(), sent.farthest.size());
  for (std::size_t i = 0; i < got.farthest.size(); ++i) {
    EXPECT_EQ(got.farthest[i].distance, sent.farthest[i].distance);
    EXPECT_EQ(got.farthest[i].number, sent.farthest[i].number);
    EXPECT_EQ(got.farthest[i].index, sent.farthest[i].index);
    EXPECT_EQ(got.farthest[i].at, sent.farthest[i].at);
  }
  EXPECT_EQ(got.seconds, sent.seconds);
}

TEST(PieceMessage, CarriesPartsOfCertificates) {
  const MeterParts sent = {{0.1, ~0u, {1, 2, 3}, 5, {{4, 0.25}, {9, 1e-300}}}, {}};
  const MeterParts got = decode_meter_parts(encode(sent));
  expect_equal(got.mesh, sent.mesh);
  expect_equal(got.reference, sent.reference);
}

TEST(PieceMessage, AChecksumSeesVerticesAndTriangles) {
  const TriangleMesh mesh = sheet(5, 0.3);
  TriangleMesh moved = mesh, turned = mesh;
  moved.vertices.back()[0] *= 1 + 0x1p-52;
  std::swap(turned.triangles.front()[0], turned.triangles.front()[1]);
  EXPECT_EQ(checksum(mesh), checksum(TriangleMesh(mesh)));
  EXPECT_NE(checksum(mesh), checksum(moved));
  EXPECT_NE(checksum(mesh), checksum(turned));
}

}  // namespace
}  // namespace emax::test
