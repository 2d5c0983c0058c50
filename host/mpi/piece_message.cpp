#include "host/mpi/piece_message.h"

#include <nlohmann/json.hpp>
#include <string>

#include "host/measure/point_distances.h"
#include "host/worker_pool/packed.h"
#include "sw_model/base/crc32.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using nlohmann::json;

json from_cbor(std::span<const std::uint8_t> bytes) {
  return json::from_cbor(bytes.begin(), bytes.end());
}

// A path may hold any bytes, which text of CBOR may not.
json packed_path(const std::filesystem::path& path) {
  const std::string& name = path.native();
  return json::binary({name.begin(), name.end()});
}

std::filesystem::path path_of(const json& value) {
  const std::vector<std::uint8_t>& bytes = value.get_binary();
  return std::string(bytes.begin(), bytes.end());
}

json to_json(const CloudCut& cut) {
  return {{"path", packed_path(cut.path)},
          {"skip_invalid", cut.reading.skip_invalid},
          {"left_out_classes", cut.reading.left_out_classes},
          {"bytes", cut.bytes},
          {"piece_points", cut.piece_points},
          {"is_complete", cut.is_complete},
          {"bounds", packed(std::vector{cut.bounds.lower, cut.bounds.upper})},
          {"marks", packed(cut.marks)}};
}

CloudCut cut_of(const json& j) {
  CloudCut cut;
  cut.path = path_of(j.at("path"));
  j.at("skip_invalid").get_to(cut.reading.skip_invalid);
  j.at("left_out_classes").get_to(cut.reading.left_out_classes);
  j.at("bytes").get_to(cut.bytes);
  j.at("piece_points").get_to(cut.piece_points);
  j.at("is_complete").get_to(cut.is_complete);
  const std::vector<Point> bounds = unpacked<Point>(j.at("bounds"));
  cut.bounds = {bounds.at(0), bounds.at(1)};
  cut.marks = unpacked<PieceMark>(j.at("marks"));
  return cut;
}

json to_json(const PieceQuestion& q) {
  return {{"worst", q.worst},
          {"distances", q.distances},
          {"certify", q.certify},
          {"limit", q.limit ? json(*q.limit) : json()},
          {"margin", q.margin},
          {"farthest", q.farthest},
          {"excluded", packed(q.excluded)}};
}

PieceQuestion question_of(const json& j) {
  PieceQuestion q;
  j.at("worst").get_to(q.worst);
  j.at("distances").get_to(q.distances);
  j.at("certify").get_to(q.certify);
  if (!j.at("limit").is_null()) q.limit = j.at("limit").get<double>();
  j.at("margin").get_to(q.margin);
  j.at("farthest").get_to(q.farthest);
  q.excluded = unpacked<std::uint32_t>(j.at("excluded"));
  return q;
}

json to_json(const CertificatePart& part) {
  std::vector<std::uint32_t> excluded;
  std::vector<double> distances;
  for (const auto& [number, distance] : part.excluded) {
    excluded.push_back(number);
    distances.push_back(distance);
  }
  return {{"upper", part.upper},
          {"worst_point", part.worst_point},
          {"at", packed(std::vector{part.at})},
          {"points", part.points},
          {"excluded", packed(excluded)},
          {"distances", packed(distances)}};
}

CertificatePart part_of(const json& j) {
  CertificatePart part;
  j.at("upper").get_to(part.upper);
  j.at("worst_point").get_to(part.worst_point);
  part.at = unpacked<Point>(j.at("at")).at(0);
  j.at("points").get_to(part.points);
  const auto excluded = unpacked<std::uint32_t>(j.at("excluded"));
  const auto distances = unpacked<double>(j.at("distances"));
  for (std::size_t i = 0; i < excluded.size(); ++i) {
    part.excluded.emplace_back(excluded[i], distances.at(i));
  }
  return part;
}

}  // namespace

Bytes encode(const PiecesTask& task) {
  return json::to_cbor({{"cloud", to_json(task.cloud)},
                        {"mesh", packed_path(task.files.mesh)},
                        {"reference", packed_path(task.files.reference)},
                        {"used_vertices_alone", task.files.used_vertices_alone},
                        {"mesh_checksum", task.mesh_checksum},
                        {"reference_checksum", task.reference_checksum},
                        {"brute_force", task.brute_force},
                        {"question", to_json(task.question)},
                        {"share", {task.share.first, task.share.last, task.share.of}}});
}

PiecesTask decode_pieces_task(std::span<const std::uint8_t> bytes) {
  const json j = from_cbor(bytes);
  PiecesTask task;
  task.cloud = cut_of(j.at("cloud"));
  task.files = {path_of(j.at("mesh")), path_of(j.at("reference")), j.at("used_vertices_alone")};
  j.at("mesh_checksum").get_to(task.mesh_checksum);
  j.at("reference_checksum").get_to(task.reference_checksum);
  j.at("brute_force").get_to(task.brute_force);
  task.question = question_of(j.at("question"));
  const json& share = j.at("share");
  task.share = {share.at(0), share.at(1), share.at(2)};
  return task;
}

std::uint32_t checksum(const TriangleMesh& mesh) {
  const auto of = [](const auto& values) {
    return crc32({reinterpret_cast<const std::uint8_t*>(values.data()),
                  values.size() * sizeof(values.front())});
  };
  const std::vector<std::uint32_t> both = {of(mesh.vertices), of(mesh.triangles)};
  return of(both);
}

Bytes encode(const PieceFindings& found, const Normalization& normalization) {
  std::vector<std::uint32_t> exact;
  std::vector<double> exact_distances;
  for (std::uint32_t i = 0; i < found.distances.size(); ++i) {
    if (found.distances[i] == in_file_units(normalization, found.squared_bits[i])) continue;
    exact.push_back(i);
    exact_distances.push_back(found.distances[i]);
  }
  std::vector<std::uint64_t> farthest;
  std::vector<double> farthest_distances;
  std::vector<Point> farthest_points;
  for (const FarthestPoint& point : found.farthest) {
    farthest.insert(farthest.end(), {point.number, point.index});
    farthest_distances.push_back(point.distance);
    farthest_points.push_back(point.at);
  }
  return json::to_cbor({{"first", found.first},
                        {"points", found.points},
                        {"worst", {found.worst.squared_bits, found.worst.worst_point}},
                        {"squared_bits", packed(found.squared_bits)},
                        {"exact", packed(exact)},
                        {"exact_distances", packed(exact_distances)},
                        {"first_number", found.first_number},
                        {"listed_numbers", packed(found.listed_numbers)},
                        {"farthest", packed(farthest)},
                        {"farthest_distances", packed(farthest_distances)},
                        {"farthest_points", packed(farthest_points)},
                        {"seconds", found.seconds}});
}

PieceFindings decode_piece_findings(std::span<const std::uint8_t> bytes,
                                    const Normalization& normalization) {
  const json j = from_cbor(bytes);
  PieceFindings found;
  j.at("first").get_to(found.first);
  j.at("points").get_to(found.points);
  found.worst = {j.at("worst").at(0), j.at("worst").at(1)};
  found.squared_bits = unpacked<std::uint32_t>(j.at("squared_bits"));
  for (const std::uint32_t bits : found.squared_bits) {
    found.distances.push_back(in_file_units(normalization, bits));
  }
  const auto exact = unpacked<std::uint32_t>(j.at("exact"));
  const auto exact_distances = unpacked<double>(j.at("exact_distances"));
  for (std::size_t i = 0; i < exact.size(); ++i) {
    found.distances.at(exact[i]) = exact_distances.at(i);
  }
  j.at("first_number").get_to(found.first_number);
  found.listed_numbers = unpacked<std::uint32_t>(j.at("listed_numbers"));
  const auto farthest = unpacked<std::uint64_t>(j.at("farthest"));
  const auto distances = unpacked<double>(j.at("farthest_distances"));
  const auto points = unpacked<Point>(j.at("farthest_points"));
  for (std::size_t i = 0; i < points.size(); ++i) {
    found.farthest.push_back({distances.at(i), static_cast<std::uint32_t>(farthest.at(2 * i)),
                              farthest.at(2 * i + 1), points[i]});
  }
  j.at("seconds").get_to(found.seconds);
  return found;
}

Bytes encode(const MeterParts& parts) {
  return json::to_cbor({{"mesh", to_json(parts.mesh)}, {"reference", to_json(parts.reference)}});
}

MeterParts decode_meter_parts(std::span<const std::uint8_t> bytes) {
  const json j = from_cbor(bytes);
  return {part_of(j.at("mesh")), part_of(j.at("reference"))};
}

}  // namespace emax
