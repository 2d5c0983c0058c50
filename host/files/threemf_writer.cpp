// 3MF: a ZIP archive of three parts, the last of which is the mesh as XML.

#include <fmt/format.h>

#include <iterator>

#include "host/files/mesh_writers.h"
#include "host/files/number_text.h"
#include "host/files/threemf_names.h"
#include "host/files/zip_archive.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

constexpr std::string_view kXml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";

std::string content_types() {
  return fmt::format(
      "{}<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">\n"
      "  <Default Extension=\"rels\" "
      "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>\n"
      "  <Default Extension=\"model\" "
      "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>\n"
      "</Types>\n",
      kXml);
}

std::string relationships() {
  return fmt::format(
      "{}<Relationships xmlns=\"{}\">\n"
      "  <Relationship Id=\"model\" Target=\"/{}\" Type=\"{}\"/>\n"
      "</Relationships>\n",
      kXml, kRelationships, kThreeMfModelPart, kThreeMfModelType);
}

std::string model(const TriangleMesh& mesh, const MeshNotes& notes) {
  std::string unit;
  if (notes.unit) {
    const std::optional<std::string_view> name = threemf_unit(*notes.unit);
    if (!name) throw Error(fmt::format("3MF has no unit {}; write .glb", notes.unit->name));
    unit = fmt::format(" unit=\"{}\"", *name);
  }
  std::string text = fmt::format(
      "{}<model{} xml:lang=\"en-US\" xmlns=\"{}\">\n"
      "<metadata name=\"Application\">emax</metadata>\n"
      "<resources>\n<object id=\"1\" type=\"model\">\n<mesh>\n<vertices>\n",
      kXml, unit, kThreeMfCore);
  for (const Point& v : mesh.vertices) {
    constexpr std::string_view kBefore[] = {"<vertex x=\"", "\" y=\"", "\" z=\""};
    for (int k = 0; k < 3; ++k) {
      text += kBefore[k];
      append_shortest(text, v[k]);
    }
    text += "\"/>\n";
  }
  text += "</vertices>\n<triangles>\n";
  for (const Triangle& t : mesh.triangles) {
    fmt::format_to(std::back_inserter(text), "<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>\n", t[0],
                   t[1], t[2]);
  }
  text +=
      "</triangles>\n</mesh>\n</object>\n</resources>\n"
      "<build>\n<item objectid=\"1\"/>\n</build>\n</model>\n";
  return text;
}

}  // namespace

std::string threemf_bytes(const TriangleMesh& mesh, const MeshNotes& notes) {
  ZipWriter zip;
  zip.add("[Content_Types].xml", content_types());
  zip.add("_rels/.rels", relationships());
  zip.add(std::string(kThreeMfModelPart), model(mesh, notes));
  return zip.finish();
}

}  // namespace emax
