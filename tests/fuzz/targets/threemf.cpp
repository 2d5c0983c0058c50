// Archives, and the XML of a model, which is packed: changed bytes of an archive mostly end at the
// checksum of an entry.
#include "host/files/threemf_names.h"
#include "host/files/zip_archive.h"
#include "tests/fuzz/files.h"

namespace emax::fuzz {
namespace {

std::string entry(const std::string& archive, const std::string& name) {
  const InputFile input = {{"seed"}, archive};
  ZipReader zip(input);
  std::string bytes;
  zip.read(name, [&](std::string_view piece) { bytes += piece; });
  return bytes;
}

// The seed with this model.
std::string packed(Input model) {
  static const std::string seed = tetrahedron(".3mf");
  ZipWriter zip;
  for (const std::string name : {"[Content_Types].xml", "_rels/.rels"}) {
    zip.add(name, entry(seed, name));
  }
  zip.add(std::string(kThreeMfModelPart), {model.begin(), model.end()});
  return zip.finish();
}

}  // namespace

void read(Input input) {
  constexpr std::uint8_t kFirstOfZip = 'P';
  const bool is_archive = !input.empty() && input.front() == kFirstOfZip;
  read_file(is_archive ? input : bytes_of(packed(input)), ".3mf");
}

std::vector<std::string> seeds() {
  // Short, so that most changes meet a number.
  const std::string triangle = "<model xmlns=\"" + std::string(kThreeMfCore) +
                               R"("><resources><object id="1"><mesh><vertices>
<vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/>
</vertices><triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object></resources>
<build><item objectid="1"/></build></model>)";
  return {tetrahedron(".3mf"), triangle};
}

}  // namespace emax::fuzz
