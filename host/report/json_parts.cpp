#include "host/report/json_parts.h"

#include <fmt/format.h>

namespace emax {
namespace {

constexpr std::pair<const char*, std::size_t MeshValidity::*> kValidityCounts[] = {
    {"boundary_edges", &MeshValidity::boundary_edges},
    {"non_manifold_edges", &MeshValidity::non_manifold_edges},
    {"non_manifold_vertices", &MeshValidity::non_manifold_vertices},
    {"inconsistent_edges", &MeshValidity::inconsistent_edges},
    {"degenerate_triangles", &MeshValidity::degenerate_triangles},
    {"self_intersections", &MeshValidity::self_intersections},
    {"self_intersecting_triangles", &MeshValidity::self_intersecting_triangles},
    {"components", &MeshValidity::components}};

constexpr std::pair<const char*, std::size_t MeshTopology::*> kTopologyCounts[] = {
    {"components", &MeshTopology::components},
    {"border_loops", &MeshTopology::border_loops},
    {"genus", &MeshTopology::genus}};

template <class Counts, class Table>
Json counts_to_json(const Counts& counts, const Table& table) {
  Json json;
  for (const auto& [key, member] : table) json[key] = counts.*member;
  return json;
}

template <class Counts, class Table>
Counts counts_from_json(const Json& json, const Table& table) {
  Counts counts;
  for (const auto& [key, member] : table) get_count(json.at(key), counts.*member);
  return counts;
}

}  // namespace

std::string bits_text(std::uint32_t bits) { return fmt::format("0x{:08x}", bits); }

Json to_json(const Normalization& transform) {
  const Point& o = transform.origin;
  return {{"origin", {o.x(), o.y(), o.z()}}, {"scale", transform.scale}};
}

Normalization normalization_from_json(const Json& json) {
  Normalization transform;
  for (Eigen::Index i = 0; i < 3; ++i) {
    json.at("origin").at(static_cast<std::size_t>(i)).get_to(transform.origin[i]);
  }
  json.at("scale").get_to(transform.scale);
  return transform;
}

Json to_json(const MeshValidity& validity) { return counts_to_json(validity, kValidityCounts); }

MeshValidity validity_from_json(const Json& json) {
  return counts_from_json<MeshValidity>(json, kValidityCounts);
}

Json to_json(const MeshTopology& topology) { return counts_to_json(topology, kTopologyCounts); }

MeshTopology topology_from_json(const Json& json) {
  return counts_from_json<MeshTopology>(json, kTopologyCounts);
}

Json to_json(const DeviceCounters& c) {
  return {{"blocks", c.blocks},
          {"pairs", c.pairs},
          {"words_in", c.words_in},
          {"words_out", c.words_out},
          {"cycles", or_null(c.cycles)},
          {"busy", or_null(c.busy)},
          {"stalled", or_null(c.stalled)},
          {"idle", or_null(c.idle)},
          {"resends", or_null(c.resends)}};
}

Json excluded_to_json(const CertifiedError& error) {
  Json points = Json::array();
  for (std::size_t i = 0; i < error.excluded.size(); ++i) {
    points.push_back({{"point", error.excluded[i]}, {"distance", error.excluded_distances[i]}});
  }
  return points;
}

}  // namespace emax
