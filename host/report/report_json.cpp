#include "host/picture/colour.h"
#include "host/report/json_parts.h"
#include "host/report/report_data.h"

namespace emax {
namespace {

template <class T, class Convert>
Json array_of(const std::vector<T>& list, const Convert& convert) {
  Json array = Json::array();
  for (const T& item : list) array.push_back(convert(item));
  return array;
}

Json triple(const Point& p) { return {p.x(), p.y(), p.z()}; }

Json named(const std::vector<NamedText>& list) {
  return array_of(list, [](const NamedText& n) -> Json {
    return {{"name", n.name}, {"text", n.text}};
  });
}

Json statistics_json(const DeviationStatistics& s) {
  const auto count = [&](std::size_t k) {
    return s.against_epsilon ? Json((*s.against_epsilon)[k]) : Json();
  };
  return {{"count", s.count},
          {"min", s.min},
          {"max", s.max},
          {"mean", s.mean},
          {"rms", s.rms},
          {"sigma", s.sigma},
          {"within_sigma", s.within_sigma},
          {"above", count(0)},
          {"within", count(1)},
          {"below", count(2)}};
}

Json points_json(const std::vector<ReportedPoint>& points, bool with_triangle) {
  return array_of(points, [&](const ReportedPoint& p) {
    Json point = {{"point", p.point}, {"position", triple(p.position)}, {"deviation", p.deviation}};
    if (with_triangle) point["triangle"] = p.triangle;
    return point;
  });
}

Json geometry_json(const ReportGeometry& g) {
  return {{"points", g.points},
          {"points_of", g.points_of},
          {"vertices", g.vertices},
          {"triangles", g.triangles},
          {"origin", triple(g.origin)},
          {"step", triple(g.step)},
          {"deviation_step", g.deviation_step},
          {"up", triple(g.up)}};
}

Json certificate_json(const ReportCertificate& c) {
  return {{"file", c.file}, {"text", c.text}, {"verify", c.verify}};
}

Json checks_json(const std::vector<ReportCheck>& checks) {
  return array_of(checks, [](const ReportCheck& c) -> Json {
    return {{"claim", c.claim}, {"holds", c.holds}, {"text", c.text}};
  });
}

Json search_json(const std::vector<ReportEvaluation>& evaluations) {
  return {{"evaluations", array_of(evaluations, [](const ReportEvaluation& e) -> Json {
             return {{"index", e.index},
                     {"seconds", or_null(e.seconds)},
                     {"triangles", or_null(e.triangles)},
                     {"feasible", e.feasible}};
           })}};
}

Json curve_json(const std::vector<ReportCurvePoint>& curve) {
  return array_of(curve, [](const ReportCurvePoint& c) -> Json {
    return {{"epsilon", c.epsilon}, {"triangles", or_null(c.triangles)}};
  });
}

Json colours_json(bool is_signed) {
  const DeviationScale& scale = deviation_scale(is_signed);
  return {{"stops", scale.stops}, {"above", scale.above}, {"below", scale.below}};
}

}  // namespace

std::string report_json(const ReportData& r) {
  const ReportMeasurement& m = r.measured;
  const DeviationHistogram& h = m.histogram;
  const auto provenance = array_of(r.provenance, [](const ReportInput& i) -> Json {
    return {{"name", i.name}, {"file", i.file}, {"sha256", i.sha256}};
  });
  const auto left_out = array_of(m.left_out, [](const LeftOut& l) -> Json {
    return {{"reason", l.reason}, {"points", l.points}};
  });
  const auto times = array_of(r.times, [](const ReportTime& t) -> Json {
    return {{"name", t.name}, {"seconds", t.seconds}};
  });
  const Json json = {
      {"schema", "emax-report-1"},
      {"command", r.command},
      {"program", r.program},
      {"title", r.title},
      {"unit", or_null(r.unit)},
      {"verdict", {{"within", or_null(r.within)}, {"text", r.verdict}}},
      {"epsilon", or_null(r.epsilon)},
      {"e_max", or_null(r.e_max)},
      {"back", or_null(r.back)},
      {"width", r.width},
      {"triangles", m.geometry.triangles},
      {"points", m.statistics.count},
      {"facts", named(r.facts)},
      {"provenance", provenance},
      {"parameters", named(r.parameters)},
      {"certificate", r.certificate ? certificate_json(*r.certificate) : Json()},
      {"checks", r.checks ? checks_json(*r.checks) : Json()},
      {"signed", m.is_signed},
      {"colours", colours_json(m.is_signed)},
      {"statistics", statistics_json(m.statistics)},
      {"histogram",
       {{"edges", h.edges}, {"counts", h.counts}, {"below", h.below}, {"above", h.above}}},
      {"worst", points_json(m.worst, true)},
      {"excluded", points_json(m.excluded, false)},
      {"excluded_count", m.excluded_count},
      {"left_out", left_out},
      {"curve", r.curve ? curve_json(*r.curve) : Json()},
      {"geometry", geometry_json(m.geometry)},
      {"search", r.search ? search_json(*r.search) : Json()},
      {"times", times}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace emax
