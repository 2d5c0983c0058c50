#include "host/report/result_json.h"

#include "hls/kernel/command_words.h"
#include "host/report/json_parts.h"
#include "host/report/shape_text.h"

namespace emax {
namespace {

Json to_json(const ResultRegion& region) {
  Json json = {{"name", region.name}, {"kind", kind_of(region.shape)}};
  json.update(equation_json(region.shape));
  json.update(Json{{"triangles", region.triangles},
                   {"area", region.area},
                   {"points", region.points},
                   {"rms", region.rms}});
  return json;
}

}  // namespace

std::string to_json_text(const ResultReport& r) {
  Json json = {
      {"schema", "emax-result-1"},
      {"kernel_version", kKernelVersion},
      {"bound", r.two_sided || (r.errors && r.errors->reference) ? kTwoSidedBound : kBound},
      {"feasible", or_null(r.feasible)},
      {"valid", r.validity ? Json(r.validity->valid()) : Json()},
      {"triangles", or_null(r.triangles)},
      {"epsilon", or_null(r.epsilon)},
      {"unit", or_null(r.unit)},
      {"e_max", r.certified ? Json(r.certified->e_max_upper) : Json()},
      {"e_max_all", r.certified ? Json(r.certified->e_max_upper_all) : Json()},
      {"e_max_squared_bits", r.kernel ? Json(bits_text(r.kernel->squared_bits)) : Json()},
      {"worst_point", r.kernel ? Json(r.kernel->worst_point) : Json()},
      {"points", r.points},
      {"excluded", r.certified ? excluded_to_json(*r.certified) : Json::array()},
      {"transform", to_json(r.transform)},
      {"evaluations", or_null(r.evaluations)},
      {"failures", or_null(r.failures)},
      {"ended_by", or_null(r.ended_by)},
      {"seed", or_null(r.seed)},
      {"device", r.device},
      {"device_counters", r.counters ? to_json(*r.counters) : Json()},
      {"validity", r.validity ? to_json(*r.validity) : Json()},
      {"topology", r.topology ? to_json(*r.topology) : Json()},
      {"reconstruction_triangles", or_null(r.reconstruction_triangles)},
      {"unmeshed_points", or_null(r.unmeshed_points)},
      {"lost_attributes", or_null(r.lost_attributes)},
      {"reference", r.reference ? to_json(*r.reference) : Json()},
      {"predicted", Json()},
      {"errors", r.errors ? to_json(*r.errors) : Json()},
      {"report", r.page.empty() ? Json() : Json(r.page)},
      {"picture", r.picture.empty() ? Json() : Json(r.picture)}};
  if (r.board && r.counters && r.counters->cycles) {
    const DeviceCounters& c = *r.counters;
    json["predicted"] = {{"board", r.board->name},
                         {"clock_hz", r.board->clock_hz},
                         {"elements", r.board->elements},
                         {"filter_elements", r.board->filter_elements},
                         {"link_bytes_per_second", r.board->link_bytes_per_second},
                         {"seconds", predicted_seconds(*r.board, c)},
                         {"computing_seconds", predicted_seconds(*r.board, *c.cycles, 0, 0)},
                         {"link_seconds", predicted_seconds(*r.board, 0, c.words_in, c.words_out)},
                         {"basis", "estimated"},
                         {"cpu_seconds", or_null(r.cpu_seconds)},
                         {"cpu_basis", "measured"}};
  }
  if (r.regions) {
    json["regions"] = Json::array();
    for (const ResultRegion& region : *r.regions) json["regions"].push_back(to_json(region));
  }
  return json.dump(2) + "\n";
}

}  // namespace emax
