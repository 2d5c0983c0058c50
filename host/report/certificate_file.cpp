#include "host/report/certificate_file.h"

#include <charconv>

#include "hls/kernel/command_words.h"
#include "host/files/input_file.h"
#include "host/report/json_parts.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

constexpr const char* kSchema = "emax-certificate-2";
// The two-sided bound of this schema did not include the distance from the reference to the mesh.
constexpr const char* kFormerSchema = "emax-certificate-1";

std::uint32_t parse_bits(const std::string& text) {
  std::uint32_t bits = 0;
  const char* end = text.data() + text.size();
  if (text.size() != 10 || !text.starts_with("0x") ||
      std::from_chars(text.data() + 2, end, bits, 16).ptr != end) {
    throw Error("'" + text + "' is not 0x and eight hexadecimal digits");
  }
  return bits;
}

ReferenceBound reference_from_json(const Json& json) {
  ReferenceBound r;
  json.at("file").get_to(r.file);
  json.at("sha256").get_to(r.sha256);
  get_count(json.at("triangles"), r.triangles);
  json.at("epsilon_back").get_to(r.epsilon_back);
  json.at("mesh_to_reference").get_to(r.mesh_to_reference);
  json.at("reference_to_mesh").get_to(r.reference_to_mesh);
  r.topology = topology_from_json(json.at("topology"));
  json.at("points_to_reference").get_to(r.points_to_reference);
  return r;
}

Certificate parse(const Json& json) {
  if (json.at("schema") == kFormerSchema) {
    throw Error(
        "it was made before topology and the way from the reference to the mesh were certified; "
        "check it with the emax that made it, or make the mesh anew");
  }
  if (json.at("schema") != kSchema) throw Error("its schema is not " + std::string(kSchema));
  if (json.at("kernel_version") != kKernelVersion) {
    throw Error("it was made by another version of the kernel; use the program that made it");
  }
  const bool two_sided = json.at("bound") == kTwoSidedBound;
  if (!two_sided && json.at("bound") != kBound) throw Error("its bound is not known");
  Certificate c;
  if (two_sided) c.reference = reference_from_json(json.at("reference"));
  const Json& mesh = json.at("mesh");
  const Json& cloud = json.at("cloud");
  mesh.at("file").get_to(c.mesh_file);
  mesh.at("sha256").get_to(c.mesh_sha256);
  get_count(mesh.at("vertices"), c.vertices);
  cloud.at("file").get_to(c.cloud_file);
  cloud.at("sha256").get_to(c.cloud_sha256);
  cloud.at("skip_invalid").get_to(c.reading.skip_invalid);
  if (cloud.contains("left_out_classes")) {
    cloud.at("left_out_classes").get_to(c.reading.left_out_classes);
  }
  c.vertices_of_mesh = cloud.value("vertices_of_mesh", false);
  get_count(json.at("triangles"), c.triangles);
  json.at("epsilon").get_to(c.epsilon);
  c.unit = json.value("unit", "");
  json.at("e_max").get_to(c.error.e_max_upper);
  get_count(json.at("worst_point"), c.kernel.worst_point);
  get_count(json.at("points"), c.error.points);
  for (const Json& point : json.at("excluded").get_ref<const Json::array_t&>()) {
    get_count(point.at("point"), c.error.excluded.emplace_back());
    c.error.excluded_distances.push_back(point.at("distance").get<double>());
  }
  json.at("e_max_all").get_to(c.error.e_max_upper_all);
  c.kernel.squared_bits = parse_bits(json.at("e_max_squared_bits").get<std::string>());
  c.validity = validity_from_json(json.at("validity"));
  json.at("valid").get_to(c.claims_valid);
  c.topology = topology_from_json(json.at("topology"));
  c.transform = normalization_from_json(json.at("transform"));
  return c;
}

}  // namespace

std::filesystem::path certificate_path(const std::filesystem::path& mesh) {
  return mesh.string() + ".certificate.json";
}

std::filesystem::path reference_path(const std::filesystem::path& mesh) {
  return mesh.string() + ".reference.ply";
}

Json to_json(const ReferenceBound& r) {
  return {{"file", r.file},
          {"sha256", r.sha256},
          {"triangles", r.triangles},
          {"topology", to_json(r.topology)},
          {"epsilon_back", r.epsilon_back},
          {"mesh_to_reference", r.mesh_to_reference},
          {"reference_to_mesh", r.reference_to_mesh},
          {"points_to_reference", r.points_to_reference}};
}

std::string to_json_text(const Certificate& c) {
  Json json = {
      {"schema", kSchema},
      {"kernel_version", kKernelVersion},
      {"bound", c.reference ? kTwoSidedBound : kBound},
      {"epsilon", c.epsilon},
      {"e_max", c.error.e_max_upper},
      {"e_max_all", c.error.e_max_upper_all},
      {"e_max_squared_bits", bits_text(c.kernel.squared_bits)},
      {"worst_point", c.kernel.worst_point},
      {"points", c.error.points},
      {"excluded", excluded_to_json(c.error)},
      {"triangles", c.triangles},
      {"valid", c.validity.valid()},
      {"validity", to_json(c.validity)},
      {"topology", to_json(c.topology)},
      {"mesh", {{"file", c.mesh_file}, {"sha256", c.mesh_sha256}, {"vertices", c.vertices}}},
      {"cloud",
       {{"file", c.cloud_file},
        {"sha256", c.cloud_sha256},
        {"skip_invalid", c.reading.skip_invalid},
        {"vertices_of_mesh", c.vertices_of_mesh}}},
      {"reference", c.reference ? to_json(*c.reference) : Json()},
      {"transform", to_json(c.transform)},
      {"method", c.chain.method},
      {"decimator", c.chain.decimator},
      {"parameters", c.chain.parameters.by_name()},
      {"seed", c.seed},
      {"evaluations", c.evaluations}};
  if (!c.unit.empty()) json["unit"] = c.unit;
  if (!c.reading.left_out_classes.empty()) {
    json["cloud"]["left_out_classes"] = c.reading.left_out_classes;
  }
  return json.dump(2) + "\n";
}

Certificate parse_certificate(std::string_view text, const std::string& name) {
  try {
    return parse(Json::parse(text));
  } catch (const Error& error) {
    throw Error(name + ": " + error.what());
  } catch (const nlohmann::json::exception&) {
    throw Error(name +
                ": is not a certificate; name the .certificate.json beside a mesh made by emax");
  }
}

Certificate read_certificate(const std::filesystem::path& path) {
  return parse_certificate(read_input(path).bytes, path.string());
}

}  // namespace emax
