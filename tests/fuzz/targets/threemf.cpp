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

// An archive with this model.
std::string packed(Input model) {
  static const std::string types = "[Content_Types].xml", relations = "_rels/.rels";
  static const std::string seed = tetrahedron(".3mf");
  static const std::string of_types = entry(seed, types), of_relations = entry(seed, relations);
  ZipWriter zip;
  zip.add(types, of_types);
  zip.add(relations, of_relations);
  zip.add(std::string(kThreeMfModelPart), {model.begin(), model.end()});
  return zip.finish();
}

}  // namespace

void read(Input input) {
  constexpr std::uint8_t kFirstOfZip = 'P';
  if (!input.empty() && input.front() == kFirstOfZip) {
    read_file(input, ".3mf");
  } else {
    read_sound_mesh(write("file.3mf", bytes_of(packed(input))));
  }
}

std::vector<std::string> seeds() {
  // Short, so that many changes meet an index.
  const std::string triangles = "<model xmlns=\"" + std::string(kThreeMfCore) +
                                R"("><resources><object id="1"><mesh><vertices>
<vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/>
</vertices><triangles><triangle v1="0" v2="1" v3="2"/><triangle v1="2" v2="1" v3="0"/>
<triangle v1="1" v2="2" v3="0"/></triangles></mesh></object></resources>
<build><item objectid="1"/></build></model>)";
  return {tetrahedron(".3mf"), triangles};
}

}  // namespace emax::fuzz
