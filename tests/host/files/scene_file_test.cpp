// GLB, 3MF and DXF: what is written is read again, transforms, units, and files that are refused.

#include <nlohmann/json.hpp>

#include "file_bytes.h"
#include "host/files/cloud_file.h"
#include "host/files/glb_layout.h"
#include "host/files/mesh_file.h"
#include "host/files/zip_archive.h"
#include "sw_model/base/deliberate_fault.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

using Json = nlohmann::ordered_json;

const TriangleMesh kTetrahedron = {{{0, 0, 0}, {1, 0, 0}, {0, 0.5, 0}, {0, 0, -2.5e3}},
                                   {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};

std::string glb(const std::string& json, const std::string& binary) {
  const auto chunk = [](std::string& bytes, std::uint32_t type, std::string content, char filler) {
    content.append((4 - content.size() % 4) % 4, filler);
    append(bytes, static_cast<std::uint32_t>(content.size()));
    append(bytes, type);
    bytes += content;
  };
  std::string chunks;
  chunk(chunks, kGlbJson, json, ' ');
  if (!binary.empty()) chunk(chunks, kGlbBinary, binary, '\0');
  std::string bytes = "glTF";
  append(bytes, std::uint32_t{2});
  append(bytes, static_cast<std::uint32_t>(12 + chunks.size()));
  return bytes + chunks;
}

// A triangle (1 0 0), (0 2 0), (0 0 3) in 16-bit indices, strided.
struct Sample {
  Sample() {
    for (int v = 0; v < 3; ++v) {
      for (int k = 0; k < 3; ++k) append(binary, k == v ? static_cast<float>(v + 1) : 0.0F);
      append(binary, 99.0F);  // what the stride passes over
    }
    for (std::uint16_t i = 0; i < 3; ++i) append(binary, i);
    json = Json::parse(R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
      "nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
                   {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],
      "bufferViews":[{"buffer":0,"byteLength":48,"byteStride":16},
                     {"buffer":0,"byteOffset":48,"byteLength":6}],
      "buffers":[{"byteLength":54}]})");
  }
  std::string bytes() const { return glb(json.dump(), binary); }

  Json json;
  std::string binary;
};

class SceneFile : public ::testing::Test {
 protected:
  TriangleMesh read(const Sample& sample) {
    return read_mesh(folder_.write("a.glb", sample.bytes()));
  }
  std::vector<Point> cloud_of(const Sample& sample) {
    return read_cloud(folder_.write("a.glb", sample.bytes())).points;
  }
  void expect_refused(std::string_view name, std::string_view bytes, std::string_view fault,
                      std::string_view remedy) {
    SCOPED_TRACE(fault);
    const auto path = folder_.write(name, bytes);
    expect_clear(message_of([&] { read_mesh(path); }), path.string() + ": ", fault, remedy);
  }
  // The sample after `change` of its JSON.
  template <class Change>
  void expect_refused_glb(const Change& change, std::string_view fault, std::string_view remedy) {
    Sample sample;
    change(sample.json);
    expect_refused("a.glb", sample.bytes(), fault, remedy);
  }

  TemporaryFolder folder_;
};

TEST_F(SceneFile, UnitsAreWrittenAndRead) {
  for (const Unit& unit : kUnits) {
    for (const std::string name : {"a.glb", "a.3mf", "a.dxf"}) {
      SCOPED_TRACE(std::string(unit.name) + " " + name);
      if (name == "a.3mf" && unit.name == "us-ft") {
        EXPECT_THROW(write_mesh(folder_ / name, kTetrahedron, {.unit = unit}), Error);
        continue;
      }
      write_mesh(folder_ / name, kTetrahedron, {.unit = unit});
      const MeshFile file = read_mesh_file(folder_ / name);
      EXPECT_EQ(file.unit, unit);
      EXPECT_EQ(file.mesh.triangles.size(), 4u);
    }
  }
  for (const auto& [name, unit] : std::vector<std::pair<std::string, std::string>>{
           {"a.glb", ""}, {"a.3mf", "mm"}, {"a.dxf", ""}}) {
    write_mesh(folder_ / name, kTetrahedron);
    EXPECT_EQ(read_mesh_file(folder_ / name).unit, unit_named(unit)) << name;
  }
  EXPECT_EQ(read_cloud(folder_ / "a.3mf").unit, unit_named("mm"));
}

TEST_F(SceneFile, GlbIsExactFarFromTheOrigin) {
  TriangleMesh far = kTetrahedron;
  for (Point& p : far.vertices) p += Point(4e6 + 0.1, -5e6 - 0.7, 1.0 / 3);
  const TriangleMesh stored = as_stored(far, Storage::kShiftedBinary32);
  EXPECT_LT(storage_displacement(far, Storage::kShiftedBinary32), 1e-4);
  EXPECT_GT(storage_displacement(far, Storage::kBinary32), 0.01);
  write_mesh(folder_ / "a.glb", far, {.unit = unit_named("mm")});
  EXPECT_EQ(read_mesh(folder_ / "a.glb").vertices, stored.vertices);
  write_mesh(folder_ / "b.glb", stored, {.unit = unit_named("mm")});
  EXPECT_EQ(bytes_of(folder_ / "a.glb"), bytes_of(folder_ / "b.glb"));
}

TEST_F(SceneFile, VerticesThatACutKeepsApartStayApart) {
  const TriangleMesh apart{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {-1, 0, 0}, {0, -1, 0}},
                           {{0, 1, 2}, {3, 4, 5}}};
  for (const std::string name : {"a.glb", "a.3mf"}) {
    write_mesh(folder_ / name, apart);
    EXPECT_EQ(read_mesh(folder_ / name).vertices, apart.vertices) << name;
  }
  write_mesh(folder_ / "a.dxf", apart);
  EXPECT_EQ(read_mesh(folder_ / "a.dxf").vertices.size(), 5u);
}

TEST_F(SceneFile, DeviationsHaveAPlace) {
  const std::vector<float> deviation = {0, 0.5F, -1, 2};
  for (const std::string name : {"a.ply", "a.glb"}) {
    write_mesh(folder_ / name, kTetrahedron, {.deviation = deviation});
    const MeshFile file = read_mesh_file(folder_ / name);
    EXPECT_EQ(file.mesh.vertices, kTetrahedron.vertices) << name;
    const std::string expected = name == "a.ply" ? "\"deviation\"" : "\"_DEVIATION\"";
    EXPECT_EQ(file.attributes, std::vector<std::string>{expected});
  }
}

TEST_F(SceneFile, DeviationsOfTrianglesHaveAPlaceInPly) {
  const std::vector<float> deviation = {0.25F, -0.5F, 1, 3};
  write_mesh(folder_ / "a.ply", kTetrahedron, {.deviation_of_triangles = deviation});
  const MeshFile file = read_mesh_file(folder_ / "a.ply");
  EXPECT_EQ(file.mesh.triangles, kTetrahedron.triangles);
  EXPECT_EQ(file.attributes, std::vector<std::string>{"\"deviation\""});
}

TEST_F(SceneFile, GroupsOfTrianglesHaveAPlaceAndLeaveTheMesh) {
  TriangleMesh apart = kTetrahedron;
  apart.vertices.push_back(apart.vertices[3]);  // stays a vertex of its own
  apart.triangles[2][2] = 4;
  const TriangleGroups groups{{1, 1, TriangleGroups::kNone, 0},
                              {{"plane_1", {10, 20, 30}}, {"plane_2", {40, 50, 60}}}};
  for (const std::string name : {"a.ply", "a.obj", "a.glb"}) {
    SCOPED_TRACE(name);
    write_mesh(folder_ / name, apart, {.groups = &groups});
    const MeshFile file = read_mesh_file(folder_ / name);
    EXPECT_EQ(file.mesh.vertices, apart.vertices);
    EXPECT_EQ(file.mesh.triangles, apart.triangles);
  }
  const std::string glb = bytes_of(folder_ / "a.glb"), obj = bytes_of(folder_ / "a.obj"),
                    ply = bytes_of(folder_ / "a.ply");
  for (const std::string_view named :
       {"\"name\":\"plane_2\"", "\"name\":\"none\"", "\"name\":\"plane_1\""}) {
    EXPECT_NE(glb.find(named), std::string::npos) << named;
  }
  EXPECT_TRUE(obj.ends_with("g plane_2\nf 1 3 2\nf 1 2 4\ng none\nf 2 3 5\ng plane_1\nf 3 1 4\n"));
  EXPECT_NE(ply.find("property int region\n"), std::string::npos);
  EXPECT_TRUE(ply.ends_with(std::string(4, '\0')));  // of the last triangle: group 0
}

TEST_F(SceneFile, GlbNodesAreTurnedScaledAndShifted) {
  Sample sample;
  EXPECT_EQ(read(sample).vertices, (std::vector<Point>{{1, 0, 0}, {0, 2, 0}, {0, 0, 3}}));
  sample.json["nodes"] = Json::parse(R"([{"translation":[10,0,0],"children":[1]},
    {"rotation":[0,0,1,0],"scale":[2,1,-1],"mesh":0}])");
  const TriangleMesh mesh = read(sample);
  EXPECT_EQ(mesh.vertices, (std::vector<Point>{{8, 0, 0}, {10, -2, 0}, {10, 0, -3}}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 2, 1}})) << "mirrored, so turned";
  EXPECT_EQ(read_mesh_file(folder_ / "a.glb").unit, unit_named("m"));
  sample.json["nodes"][1]["matrix"] = {0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 5, 6, 7, 1};
  EXPECT_EQ(read(sample).vertices, (std::vector<Point>{{15, 6, 8}, {17, 6, 7}, {15, 9, 7}}));
}

TEST_F(SceneFile, GlbHasStripsFansPointsAndLines) {
  Sample sample;
  for (const int mode : {4, 5, 6}) {
    sample.json["meshes"][0]["primitives"][0]["mode"] = mode;
    EXPECT_EQ(read(sample).triangles, (std::vector<Triangle>{{0, 1, 2}})) << mode;
  }
  sample.json["meshes"][0]["primitives"][0]["mode"] = 0;
  EXPECT_EQ(cloud_of(sample), (std::vector<Point>{{1, 0, 0}, {0, 2, 0}, {0, 0, 3}}));
  EXPECT_FALSE(holds_triangles(folder_ / "a.glb"));
  sample.json["meshes"][0]["primitives"][0]["mode"] = 1;
  expect_refused("a.glb", sample.bytes(), "holds no triangles", "give a mesh");
}

TEST_F(SceneFile, GlbQuantizedAndSeveralPrimitivesAreMerged) {
  Sample sample;
  sample.binary = std::string("\x7f\0\0\0\x80\0\0\0\0", 9);
  sample.binary.append(3, '\0');
  for (std::uint16_t i = 0; i < 3; ++i) append(sample.binary, i);
  sample.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  sample.json["accessors"][0]["componentType"] = 5120;
  sample.json["accessors"][0]["normalized"] = true;
  sample.json["bufferViews"] = Json::parse(R"([{"buffer":0,"byteLength":9,"byteStride":3},
    {"buffer":0,"byteOffset":12,"byteLength":6}])");
  sample.json["buffers"][0]["byteLength"] = 18;
  EXPECT_EQ(read(sample).vertices, (std::vector<Point>{{1, 0, 0}, {0, -1, 0}, {0, 0, 0}}));
  Json& primitives = sample.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  const TriangleMesh twice = read(sample);
  EXPECT_EQ(twice.vertices.size(), 3u);
  EXPECT_EQ(twice.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}}));
}

TEST_F(SceneFile, DamagedGlbIsRefused) {
  const std::string whole = Sample().bytes();
  for (std::size_t size = 1; size < whole.size(); ++size) {
    const auto path = folder_.write("cut.glb", whole.substr(0, size));
    expect_clear(message_of([&] { read_mesh(path); }), path.string() + ": ", "", "");
  }
  expect_refused("a.glb", "gltf" + whole.substr(4), "does not begin with \"glTF\"", "ending");
  std::string other = whole;
  other[4] = 1;
  expect_refused("a.glb", other, "version 1", "glTF 2.0");
  expect_refused("a.glb", whole + "more", "promises", "copy or export");
  expect_refused("a.glb", glb("{\"a\":", ""), "JSON cannot be parsed", "export");
  expect_refused("a.glb", glb("[1e999]", ""), "JSON cannot be parsed", "export");
  expect_refused("a.glb", glb(std::string(100000, '['), ""), "JSON cannot be parsed", "export");
  expect_refused("a.glb", glb("[]", ""), "not an object", "export");
  expect_refused("a.glb", glb("{}", ""), "version \"\" of glTF", "glTF 2.0");
  expect_refused("a.ply", whole, "that of a .glb file", "rename it to .glb");
}

TEST_F(SceneFile, GlbOfFalseContentIsRefused) {
  const auto refuse = [&](const char* at, const Json& value, std::string_view fault,
                          std::string_view remedy) {
    expect_refused_glb([&](Json& json) { json[Json::json_pointer(at)] = value; }, fault, remedy);
  };
  refuse("/extensionsRequired", {"KHR_draco_mesh_compression"}, "KHR_draco", "without compression");
  refuse("/extensionsRequired", {"EXT_meshopt_compression"}, "meshopt", "without compression");
  refuse("/extensionsRequired", {"EXT_x"}, "EXT_x", "without this extension");
  refuse("/accessors/0/count", 4, "accessors 0: 4 elements", "copy or export");
  refuse("/accessors/0/count", 9007199254740990, "elements from byte 0", "copy or export");
  refuse("/accessors/0/count", -3, "not a whole number", "export");
  refuse("/accessors/0/byteOffset", 8, "from byte 8", "copy or export");
  refuse("/accessors/0/sparse", Json::object(), "is sparse", "without sparse");
  refuse("/accessors/0/type", "VEC2", "not of type VEC3", "export");
  refuse("/accessors/1/componentType", 5122, "componentType 5122", "export");
  refuse("/accessors/0/componentType", 5130, "componentType 5130", "export");
  refuse("/bufferViews/0/byteLength", 55, "ends behind its buffer", "copy or export");
  refuse("/bufferViews/0/byteOffset", 9007199254740990, "ends behind", "copy or export");
  refuse("/bufferViews/0/byteStride", 4, "a stride of 4", "export");
  refuse("/buffers/0/byteLength", 1000, "1000 bytes are promised", "copy or export");
  refuse("/buffers/0/uri", "other.bin", "not in the file", "one .glb");
  refuse("/nodes/0/children", {0}, "contains itself", "export");
  refuse("/nodes/0/children", {7}, "refers to nodes 7", "copy or export");
  refuse("/nodes/0/skin", 0, "moved by a skin", "final shape");
  refuse("/nodes/0/matrix", {1, 2}, "a list of 16 numbers", "export");
  refuse("/nodes/0/rotation", {0, 0, 0, 0}, "no length", "export");
  refuse("/nodes/0/mesh", 1, "refers to meshes 1", "copy or export");
  refuse("/meshes/0/primitives/0/mode", 7, "no such mode 7", "export");
  refuse("/meshes/0/primitives/0/indices", 2, "refers to accessors 2", "copy or export");
  refuse("/scene", 1, "refers to scenes 1", "copy or export");
  Sample invalid;
  append(invalid.binary = invalid.binary.substr(4), 0);
  invalid.binary.replace(0, 4, "\xff\xff\xff\xff");
  expect_refused("a.glb", invalid.bytes(), "vertex 0: a coordinate is NaN", "finite");
  Sample beyond;
  beyond.binary[52] = 9;
  expect_refused("a.glb", beyond.bytes(), "vertex index 9 is outside 0..3 - 1", "export");
}

TEST_F(SceneFile, CopiesOfPartsAreLimited) {
  Sample sample;
  std::vector<std::size_t> children;
  for (std::size_t i = 1; i <= 2000; ++i) {
    sample.json["nodes"].push_back({{"mesh", 0}});
    children.push_back(i);
  }
  sample.json["nodes"][0]["children"] = children;
  Json& primitives = sample.json["meshes"][0]["primitives"];
  EXPECT_EQ(read(sample).triangles.size(), 2001u);
  for (int i = 0; i < 400; ++i) primitives.push_back(primitives[0]);
  expect_refused("a.glb", sample.bytes(), "too many vertices", "one copy");
}

// A 3MF package of these resources and this build.
std::string threemf(const std::string& resources, const std::string& build,
                    const std::string& head = "") {
  ZipWriter zip;
  zip.add("_rels/.rels",
          "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
          "<Relationship Id=\"a\" Target=\"/3D/a.model\" "
          "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>"
          "</Relationships>");
  zip.add("3D/a.model", "<model " + head +
                            " xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">"
                            "<resources>" +
                            resources + "</resources><build>" + build + "</build></model>");
  return zip.finish();
}

const std::string kObject =
    "<object id=\"1\"><mesh><vertices><vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"2\" "
    "z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"3e0\"/></vertices><triangles><triangle v1=\"0\" v2=\"1\" "
    "v3=\"2\"/></triangles></mesh></object>";

TEST_F(SceneFile, ThreeMfItemsAndComponentsAreInTheirPlaces) {
  const auto path = folder_.write(
      "a.3mf",
      threemf(kObject + "<object id=\"2\"><components><component objectid=\"1\" "
                        "transform=\"0 1 0 -1 0 0 0 0 1 10 0 0\"/><component objectid=\"1\"/>"
                        "</components></object>",
              "<item objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 -1 0 0 5\"/>", "unit=\"micron\""));
  const MeshFile file = read_mesh_file(path);
  EXPECT_EQ(file.unit, unit_named("um"));
  EXPECT_EQ(
      file.mesh.vertices,
      (std::vector<Point>{{10, 1, 5}, {8, 0, 5}, {10, 0, 2}, {1, 0, 5}, {0, 2, 5}, {0, 0, 2}}));
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 2, 1}, {3, 5, 4}})) << "mirrored";
}

TEST_F(SceneFile, FalseThreeMfIsRefused) {
  const std::string item = "<item objectid=\"1\"/>";
  const auto refuse = [&](const std::string& bytes, std::string_view fault,
                          std::string_view remedy) {
    expect_refused("a.3mf", bytes, fault, remedy);
  };
  const auto changed = [&](std::string_view from, std::string_view to) {
    std::string object = kObject;
    object.replace(object.find(from), from.size(), to);
    return threemf(object, item);
  };
  EXPECT_EQ(read_mesh(folder_.write("a.3mf", threemf(kObject, item))).triangles.size(), 1u);
  refuse("no archive at all", "not a ZIP archive", "copy or export");
  refuse(threemf(kObject, ""), "holds no triangles", "give a mesh");
  refuse(threemf(kObject, "<item objectid=\"7\"/>"), "object 7 is used but not there", "export");
  refuse(threemf("<object id=\"1\"><components><component objectid=\"1\"/></components></object>",
                 item),
         "object 1 contains itself", "export");
  refuse(changed("v3=\"2\"", "v3=\"3\""), "vertex index 3 is outside 0..3 - 1", "export");
  refuse(changed("x=\"1\"", "x=\"1,5\""), "\"1,5\" is not a 64-bit number", "export");
  refuse(changed("x=\"1\"", "x=\"nan\""), "vertex 0: a coordinate is NaN", "finite");
  refuse(changed("x=\"1\"", ""), "\"x\" is missing", "export");
  refuse(changed("</triangles>", ""), "is not XML", "copy or export");
  refuse(changed("<vertices>", "<vertices/><vertex x=\"1\" y=\"1\" z=\"1\"/><vertices>"),
         "<vertex> cannot stand here", "export");
  refuse(threemf(kObject + kObject, item), "a second object 1", "export");
  refuse(threemf(kObject, "<item objectid=\"1\" transform=\"1 0 0\"/>"), "12 numbers", "export");
  refuse(threemf(kObject, item, "unit=\"parsec\""), "no such unit \"parsec\"", "millimeter");
  refuse(threemf(kObject, item, "requiredextensions=\"b\" xmlns:b=\"urn:beam\""),
         "the extension \"urn:beam\"", "plain mesh");
  // Ten levels of ten components each.
  std::string levels = kObject;
  for (int level = 2; level <= 9; ++level) {
    levels += "<object id=\"" + std::to_string(level) + "\"><components>";
    for (int i = 0; i < 10; ++i) {
      levels += "<component objectid=\"" + std::to_string(level - 1) + "\"/>";
    }
    levels += "</components></object>";
  }
  refuse(threemf(levels, "<item objectid=\"9\"/>"), "too many vertices", "one copy");
  // 80 MB of blanks in 80 kB.
  refuse(threemf(kObject + std::string(80'000'000, ' '), item), "more than 100 times", "another");
  ZipWriter entities;
  entities.add("_rels/.rels", "<!DOCTYPE a [<!ENTITY b \"c\">]><a>&b;</a>");
  refuse(entities.finish(), "document type", "without one");
  ZipWriter other;
  other.add("word/document.xml", "<a/>");
  refuse(other.finish(), "no such entry", "export");
  const std::string whole = threemf(kObject, item);
  for (std::size_t size = 1; size < whole.size(); size += 7) {
    const auto path = folder_.write("cut.3mf", whole.substr(0, size));
    expect_clear(message_of([&] { read_mesh(path); }), path.string() + ": ", "", "");
  }
}

TEST_F(SceneFile, DxfFacesAreReadAndOtherSurfacesRefused) {
  const auto drawing = [](const std::string& entities) {
    return "999\na comment\n0\nSECTION\n2\nTABLES\n0\nTABLE\n0\nENDTAB\n0\nENDSEC\n  0\r\nSECTION\n"
           "2\nENTITIES\n" +
           entities + "0\nENDSEC\n0\nEOF\n";
  };
  const std::string square =
      "0\n3DFACE\n8\nwalls\n10\n0\n20\n0\n30\n0\n11\n1\n21\n0\n31\n0\n12\n1\n22\n1\n32\n0\n13\n0\n"
      "23\n1\n33\n0\n70\n15\n";
  const MeshFile file =
      read_mesh_file(folder_.write("a.dxf", drawing(square + "0\nLINE\n10\n5\n")));
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(file.attributes, (std::vector<std::string>{"\"LINE\""}));
  EXPECT_EQ(file.unit, std::nullopt);
  const auto refuse = [&](const std::string& bytes, std::string_view fault,
                          std::string_view remedy) {
    expect_refused("a.dxf", bytes, fault, remedy);
  };
  refuse(drawing("0\nLINE\n"), "holds no triangles", "give a mesh");
  refuse(drawing(square + "0\nINSERT\n"), "the entity INSERT", "explode");
  refuse(drawing(square.substr(0, square.find("23\n"))), "lacks a coordinate", "export");
  refuse(drawing("0\n3DFACE\n10\nx\n"), "\"x\" is not a 64-bit number", "export");
  refuse(drawing(square).substr(0, 150), "without \"EOF\"", "copy or export");
  refuse("AutoCAD Binary DXF\r\n", "binary DXF", "text DXF");
  refuse("garbage\n", "not a group code", "export");
}

// Each fault makes the test that would see it fail.
using SceneFileFault = SceneFile;

TEST_F(SceneFileFault, IndicesThatAreTrustedReachTheMesh) {
  const DeliberateFault fault(Fault::kTrustsIndices);
  Sample beyond;
  beyond.binary[52] = 9;
  EXPECT_EQ(read_mesh(folder_.write("a.glb", beyond.bytes())).triangles.front()[2], 9u);
}

}  // namespace
}  // namespace emax::test
