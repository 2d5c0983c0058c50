#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "host/app/facts.h"
#include "host/geometry/mesh_topology.h"
#include "host/report/certificate_file.h"

namespace emax {

// "1 component, closed, genus 0", with a note whether the reference has the same topology.
std::string describe(const MeshTopology& mesh, const std::optional<MeshTopology>& reference);

// Prints the certified distances between mesh and reference, two lines.
void print(Facts& facts, const ReferenceBound& bound, double epsilon, double width,
           const std::filesystem::path& reference);

}  // namespace emax
