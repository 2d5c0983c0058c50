#include "host/tiles/part_plan.h"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "host/files/atomic_file.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 3> kSteps = {"look", "measure", "contour"};
constexpr std::array<std::string_view, 3> kLastFiles = {kAroundNormals, kExtent, kTriangles};

json numbers(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }

Eigen::Vector3f vector_of(const json& j) {
  return {j.at(0).get<float>(), j.at(1).get<float>(), j.at(2).get<float>()};
}

std::filesystem::path plan_file(const std::filesystem::path& folder) {
  return folder / "plan.json";
}

}  // namespace

std::string_view to_string(PartStep step) { return kSteps[static_cast<std::size_t>(step)]; }

PartStep part_step_named(std::string_view name) {
  for (std::size_t step = 0; step < kSteps.size(); ++step) {
    if (kSteps[step] == name) return static_cast<PartStep>(step);
  }
  throw Error("there is no step '" + std::string(name) + "' of a part");
}

std::filesystem::path part_file(const std::filesystem::path& folder, std::string_view what,
                                std::size_t part) {
  return folder / fmt::format("{}-{}.bin", what, part);
}

std::filesystem::path done_file(const std::filesystem::path& folder, PartStep step,
                                std::size_t part) {
  return part_file(folder, kLastFiles[static_cast<std::size_t>(step)], part);
}

void write_plan(const std::filesystem::path& folder, const PartPlan& plan) {
  const json all = {{"values", plan.values.by_name()}, {"thin", plan.thin},
                    {"simplify", plan.simplify},       {"halo", plan.halo},
                    {"compared", plan.compared},       {"spacing", plan.spacing},
                    {"low", numbers(plan.extent.low)}, {"high", numbers(plan.extent.high)},
                    {"reach", plan.extent.reach},      {"signs", plan.signs}};
  write_atomically(plan_file(folder), all.dump());
}

PartPlan read_plan(const std::filesystem::path& folder) {
  try {
    std::ifstream file(plan_file(folder));
    const json all = json::parse(file);
    return {.values = ParameterValues(all.at("values").get<ParameterValues::ByName>()),
            .thin = all.at("thin"),
            .simplify = all.at("simplify"),
            .halo = all.at("halo"),
            .compared = all.at("compared"),
            .spacing = all.at("spacing"),
            .extent = {vector_of(all.at("low")), vector_of(all.at("high")), all.at("reach")},
            .signs = all.at("signs").get<std::vector<std::vector<float>>>()};
  } catch (const json::exception& error) {
    throw Error(plan_file(folder).string() + ": is no plan: " + error.what());
  }
}

}  // namespace emax
