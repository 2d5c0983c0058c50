#include "host/app/tolerated_meshes.h"

#include <algorithm>

#include "host/app/scan.h"
#include "sw_model/base/error.h"

namespace emax {

std::vector<ToleratedMesh> tolerated_meshes(const std::string& tolerances, int level,
                                            const std::filesystem::path& output) {
  if (level > 0) return {{"", *given_tolerance(tolerances, level), output}};
  std::vector<ToleratedMesh> meshes;
  for (std::size_t start = 0; start <= tolerances.size();) {
    const std::size_t end = std::min(tolerances.find(',', start), tolerances.size());
    const std::string text = tolerances.substr(start, end - start);
    meshes.push_back({text, parse_tolerance(text), output});
    start = end + 1;
  }
  if (meshes.size() == 1) return meshes;
  for (const ToleratedMesh& mesh : meshes) {
    if (std::ranges::count(meshes, mesh.text, &ToleratedMesh::text) > 1) {
      throw Error("--max-error: " + mesh.text + " is given twice");
    }
  }
  for (ToleratedMesh& mesh : meshes) mesh.output = named_for(output, mesh);
  return meshes;
}

std::string named_for(const std::filesystem::path& file, const ToleratedMesh& mesh) {
  if (file.empty()) return "";
  std::string label = mesh.text;
  if (mesh.tolerance.percent) label.replace(label.size() - 1, 1, "pct");
  std::filesystem::path named = file;
  named.replace_filename(file.stem().string() + "-" + label + file.extension().string());
  return named.string();
}

std::optional<Tolerance> given_hole_reach(const std::string& text, const std::string& features) {
  if (!text.empty() && features == kNoFeatures) {
    throw Error("--hole-reach: give --features planes, all or auto, too");
  }
  if (text.empty() || text == kNoHoleReach) return std::nullopt;
  return parse_tolerance(text, "--hole-reach");
}

}  // namespace emax
