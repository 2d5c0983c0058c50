#include "host/app/reference_text.h"

#include <fmt/format.h>

namespace emax {

std::string describe(const MeshTopology& mesh, const std::optional<MeshTopology>& reference) {
  std::string text = describe(mesh);
  if (reference) {
    text +=
        *reference == mesh ? ", like the reference" : "; the reference: " + describe(*reference);
  }
  return text;
}

void print(Facts& facts, const ReferenceBound& bound, double epsilon, double width,
           const std::filesystem::path& reference) {
  const auto line = [&](const char* name, double length, double limit, const std::string& what) {
    facts.add(name, "{:.9g} certified, at most {:.9g} ({:.4g}% of the width): {}", length, limit,
              100 * length / width, what);
  };
  line("to reference", bound.mesh_to_reference, bound.epsilon_back,
       "all of the mesh to " + reference.string());
  line("from reference", bound.reference_to_mesh, epsilon, "all of the reference to the mesh");
}

}  // namespace emax
