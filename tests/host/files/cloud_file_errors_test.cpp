// Files that must not be read, each with what its message must say.

#include "file_bytes.h"
#include "host/files/cloud_file.h"
#include "tests/support/messages.h"
#include "tests/support/stimuli.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

struct BadFile {
  std::string name;
  std::string bytes;
  std::string fault;
  std::string remedy;
};

void expect_refused(const std::vector<BadFile>& files) {
  const TemporaryFolder folder;
  for (const BadFile& bad : files) {
    SCOPED_TRACE(bad.name + ": " + bad.fault);
    const std::filesystem::path path = folder.write(bad.name, bad.bytes);
    for (const bool skip_invalid : {false, true}) {
      const std::string message = message_of([&] { read_cloud(path, {skip_invalid}); });
      expect_clear(message, path.string() + ": ", bad.fault, bad.remedy);
    }
  }
}

std::string text_ply(std::string_view counts_and_properties, std::string_view body) {
  return "ply\nformat ascii 1.0\n" + std::string(counts_and_properties) + "end_header\n" +
         std::string(body);
}

constexpr std::string_view kTwoVertices =
    "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n";

std::string with_faces(std::string_view body) {
  return text_ply(
      std::string(kTwoVertices) + "element face 1\nproperty list uchar int vertex_indices\n",
      "1 2 3\n4 5 6\n" + std::string(body));
}

std::string binary_ply(std::string_view count, std::size_t body_bytes) {
  return "ply\nformat binary_little_endian 1.0\nelement vertex " + std::string(count) +
         "\nproperty double x\nproperty double y\nproperty double z\nend_header\n" +
         std::string(body_bytes, '\1');
}

std::string pcd(std::string_view body, std::string_view data = "ascii",
                std::string_view points = "2") {
  return "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " +
         std::string(points) + "\nHEIGHT 1\nPOINTS " + std::string(points) + "\nDATA " +
         std::string(data) + "\n" + std::string(body);
}

std::string garbage() {
  std::string bytes;
  std::uint32_t state = 12345;
  for (int i = 0; i < 1000; ++i) append(bytes, state = state * 1664525 + 1013904223);
  return bytes;
}

TEST(BadCloud, AnyFormat) {
  expect_refused({{"empty.ply", "", "empty", "export"},
                  {"blank.xyz", "\n \n# nothing\n", "ends after line 3", "export"},
                  {"unknown.foo", "1 2 3\n", "unknown ending \".foo\"", ".ply, .pcd, .xyz"},
                  {"none", "1 2 3\n", "unknown ending", ".ply"},
                  {"mesh.stl", "solid x\nendsolid\n", "unknown ending", ".off"},
                  {"really.xyz", "ply\nformat ascii 1.0\n", "a .ply file", "rename it to .ply"},
                  {"really.ply", "OFF\n1 0 0\n1 2 3\n", "a .off file", "rename it to .off"},
                  {"really.obj", "# .PCD v.7\nVERSION .7\n", "a .pcd file", "rename"},
                  {"really.off", "solid x\nendsolid x\n", "a .stl file", "rename"},
                  {"points.ply", "1 2 3\n4 5 6\n", "\"ply\"", "ending"},
                  {"points.off", "1 2 3\n4 5 6\n", "line 1: does not begin with OFF", "OFF"},
                  {"points.pcd", "1 2 3\n4 5 6\n", "line 1: unknown header word", "export"},
                  {"points.obj", "1 2 3\n4 5 6\n", "line 1: \"1\"", "OBJ"},
                  {"garbage.ply", garbage(), "\"ply\"", "ending"},
                  {"garbage.off", garbage(), "line 1", "OFF"},
                  {"garbage.pcd", garbage(), "line 1", "export"},
                  {"garbage.obj", garbage(), "line 1", "OBJ"},
                  {"garbage.xyz", garbage(), "line 1", "export"},
                  {"garbage.pts", garbage(), "line 1", "export"}});
}

TEST(BadCloud, Ply) {
  expect_refused(
      {{"a.ply", text_ply(kTwoVertices, "1.25 2.25 3.25\n"), "line 8 where vertex 1 of 2",
        "export"},
       {"a.ply", text_ply(kTwoVertices, "1 2 3\n4 5 6\n7 8 9\n"), "line 10: more lines", "export"},
       {"a.ply", text_ply(kTwoVertices, "1.25 2.25 3.25\n4 5\n"), "line 9: only 2 values",
        "export"},
       {"a.ply", text_ply(kTwoVertices, "1 2 3\n4 5 6 7\n"), "line 9: 4 values", "export"},
       {"a.ply", text_ply(kTwoVertices, "1 2 3\n4 5 6x\n"), "line 9: \"6x\"", "correct"},
       {"a.ply", text_ply(kTwoVertices, "1 2 3\n4 5,,5 6\n"), "\"5,,5\"", "correct"},
       {"a.ply", text_ply(kTwoVertices, "1 2 3\n4 5 1e999\n"), "\"1e999\"", "correct"},
       {"a.ply", text_ply(kTwoVertices, "1 2 3\n4 5 +-6\n"), "\"+-6\"", "correct"},
       {"a.ply",
        text_ply("element vertex 1000000000000\nproperty float x\n"
                 "property float y\nproperty float z\n",
                 "1 2 3\n"),
        "promises 1000000000000 \"vertex\" elements", "truncated"},
       {"a.ply", text_ply("element vertex -2\nproperty float x\n", ""), "-2 is negative", "export"},
       {"a.ply", text_ply("element vertex 2\nproperty float x\nproperty float y\n", "1 2\n3 4\n"),
        "no element \"vertex\" with", "coordinates"},
       {"a.ply",
        text_ply("element point 1\nproperty float x\nproperty float y\n"
                 "property float z\n",
                 "1 2 3\n"),
        "no element \"vertex\"", "names"},
       {"a.ply",
        text_ply("element vertex 0\nproperty float x\nproperty float y\n"
                 "property float z\n",
                 ""),
        "no points", "export"},
       {"a.ply", text_ply(std::string(kTwoVertices) + "element vertex 2\nproperty int i\n", ""),
        "line 7: element \"vertex\" appears twice", "export"},
       {"a.ply",
        text_ply(std::string(kTwoVertices) + "element odd 9999999999999\n", "1 2 3\n4 5 6\n"),
        "\"odd\" has no properties", "export"},
       {"a.ply", text_ply("element vertex 2\nproperty quad x\n", ""), "\"quad\"", "export"},
       {"a.ply", text_ply("element vertex 2\nproperty list float int x\n", ""), "\"float\"",
        "export"},
       {"a.ply", text_ply("property float x\n", ""), "before any element", "export"},
       {"a.ply", text_ply("elephant 1\n", ""), "line 3: unknown header word", "export"},
       {"a.ply", "ply\nformat ascii 2.0\n", "line 2: no such PLY format", "export"},
       {"a.ply", "ply\nelement vertex 1\nproperty float x\nend_header\n", "no format", "export"},
       {"a.ply", "ply\nformat ascii 1.0\nelement vertex 1\n", "\"end_header\"", "truncated"},
       {"a.ply", with_faces("3 0 1 2\n"), "line 12: vertex index 2 is outside", "export"},
       {"a.ply", with_faces("3 0 1 -1\n"), "vertex index -1", "export"},
       {"a.ply", with_faces("3 0 1\n"), "list of 3 values", "export"},
       {"a.ply", with_faces("2 0 1\n"), "2 corners", "export"},
       {"a.ply", with_faces("-3 0 1 1\n"), "list of -3", "export"},
       {"a.ply", with_faces("3 0 1 1.5\n"), "\"1.5\" is not a whole number", "export"},
       {"a.ply", with_faces(""), "\"face\" elements", "truncated"},
       {"b.ply", binary_ply("2", 47), "promises 2 \"vertex\" elements", "truncated"},
       {"b.ply", binary_ply("2", 49), "1 bytes follow", "truncated"},
       {"b.ply", binary_ply("1000000000000", 48), "has room for 2", "truncated"},
       {"b.ply", binary_ply("18446744073709551615", 48), "not a whole number", "export"},
       {"b.ply", binary_ply("768614336404564651", 48), "has room for 2", "truncated"}});
}

TEST(BadCloud, Pcd) {
  expect_refused(
      {{"a.pcd", pcd("1.25 2.25 3.25\n"), "point 1 of 2", "truncated"},
       {"a.pcd", pcd("1 2 3\n4 5 6\n7 8 9\n"), "line 12: more points than the 2", "export"},
       {"a.pcd", pcd("1.25 2 3\n4 5\n"), "line 11: 2 columns", "export"},
       {"a.pcd", pcd("1 2 3\n4 5 x\n"), "line 11: \"x\"", "export"},
       {"a.pcd", pcd("1 2 3\n", "ascii", "1000000000000"), "1000000000000 points", "truncated"},
       {"a.pcd", pcd("", "ascii", "0"), "no points", "export"},
       {"a.pcd", pcd(std::string(23, '\1'), "binary"), "promises 2 points", "truncated"},
       {"a.pcd", pcd(std::string(24, '\1'), "binary", "1000000000000"), "room for 2", "trunc"},
       {"a.pcd", pcd("1234567", "binary_compressed"), "before its compressed", "truncated"},
       {"a.pcd", pcd(std::string(8, '\0'), "binary_compressed"), "cannot be the promised",
        "truncated"},
       {"a.pcd", pcd(std::string(8, '\0'), "binary_compressed", "1000000000000"),
        "1000000000000 points", "truncated"},
       // 3.6 GB promised of 8 bytes: refused before it is allocated.
       {"a.pcd", pcd(std::string("\0\0\0\0\x00\xa4\x93\xd6", 8), "binary_compressed", "300000000"),
        "cannot be the promised", "truncated"},
       {"a.pcd", pcd("", "zip"), "line 9: DATA is none of", "export"},
       {"a.pcd", "FIELDS x y z\nSIZE 4 4\n", "line 2: needs one value for each", "export"},
       {"a.pcd", "FIELDS x y z\nSIZE 4 4 3\nTYPE F F F\nWIDTH 1\nDATA ascii\n1 2 3\n",
        "field \"z\" of type F and 3 bytes", "export"},
       {"a.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 -1 1\n", "line 4: COUNT is",
        "export"},
       {"a.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 0 1\n", "line 4: COUNT is",
        "export"},
       {"a.pcd",
        "FIELDS x _ y z\nSIZE 4 1 4 4\nTYPE F U F F\nCOUNT 1 -5 1 1\nWIDTH 1\nDATA ascii\n",
        "outside of its point", "truncated"},
       {"a.pcd",
        "FIELDS x y z _\nSIZE 4 4 4 1\nTYPE F F F U\nCOUNT 1 1 1 -4\nWIDTH 1\nDATA ascii\n",
        "outside of its point", "truncated"},
       {"a.pcd", "FIELDS x y\nWIDTH 1\nDATA ascii\n1 2\n", "no FIELDS x, y and z", "fields"},
       {"a.pcd", "FIELDS x y z\nDATA ascii\n1 2 3\n", "neither POINTS nor WIDTH", "export"},
       {"a.pcd", "FIELDS x y z\nWIDTH 2\nHEIGHT 2\nPOINTS 3\nDATA ascii\n1 2 3\n",
        "POINTS 3 is not WIDTH 2 x HEIGHT 2", "export"},
       {"a.pcd", "FIELDS x y z\nWIDTH 2\nHEIGHT 1\n", "\"DATA\"", "truncated"}});
}

TEST(BadCloud, Text) {
  expect_refused({{"a.xyz", "1 2 3\n4 5\n", "line 2: 2 columns", "export"},
                  {"a.xyz", "1 2 3\n4 5 6 7\n", "line 2: 4 columns", "export"},
                  {"a.xyz", "1 2\n", "line 1: 2 columns are not a point", "x y z"},
                  {"a.xyz", "1 2 3 4 5\n1 2 3 4\n", "line 2: 4 columns where", "export"},
                  {"a.xyz", "1 2 3 9 9 9 0 0 1\n1 2 3 9 9 9 0 0 up\n", "line 2: \"up\"", "correct"},
                  {"a.xyz", "x y z\n1 2 3\n", "line 1: \"x\" is not a 64-bit number", "correct"},
                  {"a.xyz", "1 2 3\n4 5 0x6\n", "\"0x6\"", "correct"},
                  {"a.xyz", "1 2 3\n4 5 6abc\n", "\"6abc\"", "correct"},
                  {"a.xyz", "1 2 3 ok\n", "\"ok\"", "correct"},
                  {"a.asc", "1;2,x;3\n", "\"2,x\"", "correct"},
                  {"a.asc", "1,2,\n", "\"\" is not", "correct"},
                  {"a.asc", "1,2,3\n4 5 6\n", "line 2: 1 columns", "correct"},
                  {"a.xyz", "3\ncomment\nC 1 2 3\n", "line 1: 1 columns", "x y z"},
                  {"a.pts", "3\n1 2 3\n4 5 6\n", "promises 3 points, 2 follow", "truncated"},
                  {"a.pts", "2\n1 2 3\n4 5 6\n7 8 9\n", "line 4: more lines than the 2", "export"},
                  {"a.pts", "1000000000000\n1 2 3\n", "1 follow", "truncated"},
                  {"a.pts", "2\n", "the first of 2 points", "truncated"},
                  {"a.pts", "-1\n1 2 3\n", "-1 is negative", "export"},
                  {"a.pts", "1.5\n1 2 3\n", "\"1.5\" is not a whole number", "export"}});
}

TEST(BadCloud, DecimalCommasAreNamedWithTheirRemedy) {
  std::vector<BadFile> files;
  const auto add = [&files](std::string name, std::string bytes, std::string where) {
    files.push_back({std::move(name), std::move(bytes), std::move(where) + " has a decimal comma",
                     "decimal points"});
  };
  add("a.xyz", "1,5 2,5 3,5\n", "line 1: \"1,5 2,5 3,5\"");
  add("a.xyz", "1,5\t2,5\t3,5\t255\n", "line 1: \"1,5?2,5?3,5?255\"");
  add("a.xyz", "1,5, 2,5, 3,5\n", "line 1: \"1,5, 2,5, 3,5\"");
  add("a.xyz", "-1 2 -3,25e4\n", "line 1: \"-1 2 -3,25e4\"");
  add("a.xyz", "1 2 3\n4,5 5 6\n", "line 2: \"4,5\"");
  add("a.asc", "1;2,5;3\n", "line 1: \"2,5\"");
  add("a.pts", "2\n1,5 2,5 3,5\n4,5 5,5 6,5\n", "line 2: \"1,5 2,5 3,5\"");
  add("a.ply", text_ply(kTwoVertices, "1 2 3\n4 5,5 6\n"), "line 9: \"5,5\"");
  add("a.pcd", pcd("1 2 3\n4 5,5 6\n"), "line 11: \"5,5\"");
  add("a.obj", "v 1 2 3\nv 4 5,5 6\n", "line 2: \"5,5\"");
  add("a.off", "OFF\n1 0 0\n1,5 2,5 3,5\n", "line 3: \"1,5\"");
  expect_refused(files);
}

TEST(BadCloud, Obj) {
  expect_refused(
      {{"a.obj", "# only words\no x\n", "no points", "export"},
       {"a.obj", "v 1 2 3\nv 4 5\n", "line 2: 2 columns", "export"},
       {"a.obj", "v 1 2 3\nv 4 5 6 7 8\n", "line 2: 5 columns", "export"},
       {"a.obj", "v 1 2 3\nv 4 5 6-\n", "\"6-\"", "export"},
       {"a.obj", "v 1 2 3 red\n", "\"red\"", "export"},
       {"a.obj", "v 1 2 3\nvn 1 2\n", "line 2: a normal", "export"},
       {"a.obj", "v 1 2 3\nvn 1 2 z\n", "\"z\"", "export"},
       {"a.obj", "v 1 2 3\nv 4 5 6\nf 1 2 3\nf 1 1 2\n", "line 3: vertex 3 of only 2", "truncated"},
       {"a.obj", "v 1 2 3\nf 1 1 -2\n", "vertex index -1", "export"},
       {"a.obj", "v 1 2 3\nf 0 1 1\n", "line 2: \"0\"", "export"},
       {"a.obj", "v 1 2 3\nf 1 1\n", "2 corners", "export"},
       {"a.obj", "v 1 2 3\nf 1/ 1 1\n", "\"1/\"", "export"},
       {"a.obj", "v 1 2 3\nf 1/1/1/1 1 1\n", "\"1/1/1/1\"", "export"},
       {"a.obj", "v 1 2 3\nf 1 1 99999999999999999999\n", "\"99999999999999999999\"", "export"},
       {"a.obj", "v 1 2 3\nf 1 1 9999999999999\n", "vertex index 9999999999998", "export"},
       {"a.obj", "v 1 2 3\ncurv 1 2\n", "line 2: \"curv\"", "polygons"}});
}

TEST(BadCloud, Off) {
  expect_refused(
      {{"a.off", "OFF\n2 0 0\n1.25 2.25 3.25\n", "vertex 1 of 2", "truncated"},
       {"a.off", "OFF\n1 0 0\n1 2 3\n4 5 6\n", "line 4: more lines", "export"},
       {"a.off", "OFF\n1 0 0\n1 2 3 4\n", "line 3: 4 columns", "export"},
       {"a.off", "OFF\n1 0 0\n1 2 \n# some comment\n", "line 3: 2 columns", "export"},
       {"a.off", "OFF\n1 0 0\n1 2 z\n", "\"z\"", "export"},
       {"a.off", "COFF\n1 0 0\n1 2 3\n# pad\n", "3 columns do not make a vertex of COFF", "export"},
       {"a.off", "NOFF\n1 0 0\n1 2 3 4 5\n# pad\n", "5 columns", "export"},
       {"a.off", "4OFF\n1 0 0\n1 2 3 4\n", "line 1: does not begin", "plain OFF"},
       {"a.off", "OFF\n1 0\n1 2 3\n", "line 2: three counts", "export"},
       {"a.off", "OFF\n", "the counts", "truncated"},
       {"a.off", "OFF\n0 0 0\n", "no points", "export"},
       {"a.off", "OFF\n1000000000000 0 0\n1 2 3\n", "promises 1000000000000 vertices", "truncated"},
       {"a.off", "OFF\n1 1000000000000 0\n1 2 3\n", "promises 1000000000000 faces", "truncated"},
       {"a.off", "OFF\n-1 0 0\n1 2 3\n", "-1 is negative", "export"},
       {"a.off", "OFF\n1 1 0\n1.25 2 3\n", "face 0 of 1", "truncated"},
       {"a.off", "OFF\n1 1 0\n1 2 3\n3 0 0\n", "line 4: 3 columns do not hold", "export"},
       {"a.off", "OFF\n1 1 0\n1 2 3\n3 0 0 1\n", "vertex index 1 is outside", "export"},
       {"a.off", "OFF\n1 1 0\n1 2 3\n3 0 0 0 1 2\n", "2 values follow", "export"},
       {"a.off", "OFF\n1 1 0\n1 2 3\n3 0 0 0 red\n", "\"red\"", "export"},
       {"a.off", "OFF\n1 1 0\n1 2 3\n2 0 0\n", "2 corners", "export"},
       {"a.off", "OFF\n1 1 0\n1 2 3\n99999999999 0 0\n", "99999999999 corners", "export"}});
}

TEST(BadCloudPath, MissingFolderUnreadableAndDevice) {
  const TemporaryFolder folder;
  const auto message = [](const std::filesystem::path& path) {
    return message_of([&] { read_cloud(path); });
  };
  const std::filesystem::path missing = folder / "missing.ply";
  expect_clear(message(missing), missing.string(), "no such file", "path");
  const std::filesystem::path below_file = folder.write("f.ply", "ply") / "x.ply";
  expect_clear(message(below_file), below_file.string(), "no such file", "path");
  const std::filesystem::path directory = folder / "folder.ply";
  std::filesystem::create_directory(directory);
  expect_clear(message(directory), directory.string(), "is a folder", "name a file");
  const std::filesystem::path device = folder / "zero.xyz";
  std::filesystem::create_symlink("/dev/zero", device);
  expect_clear(message(device), device.string(), "not a regular file", "copy");
  // Opens, but every read of its first byte fails, for root too.
  const std::filesystem::path unreadable = folder / "memory.xyz";
  std::filesystem::create_symlink("/proc/self/mem", unreadable);
  expect_clear(message(unreadable), unreadable.string(), "cannot be read", "permissions");
}

const std::vector<Point> kWhole{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};

// kWhole in every format.
std::vector<std::pair<std::string, std::string>> whole_files() {
  const std::string text = "1 2 3\n4 5 6\n7 8 9\n";
  std::string ply = binary_ply("3", 0);
  std::string pcd_values;
  std::string packed;  // LZF: runs of literals, at most 32 bytes each
  for (int i = 1; i <= 9; ++i) {
    append(ply, double(i));
    append(pcd_values, float(i));
  }
  append(packed, std::uint32_t{38});
  append(packed, std::uint32_t{36});
  std::string by_field;
  for (int k = 1; k <= 3; ++k) {
    for (int i = 0; i < 3; ++i) append(by_field, float(3 * i + k));
  }
  packed += '\x1f' + by_field.substr(0, 32) + '\x03' + by_field.substr(32);
  return {{"a.ply", text_ply("element vertex 3\nproperty float x\nproperty float y\n"
                             "property float z\n",
                             text)},
          {"b.ply", ply},
          {"a.pcd", pcd(text, "ascii", "3")},
          {"b.pcd", pcd(pcd_values, "binary", "3")},
          {"c.pcd", pcd(packed, "binary_compressed", "3")},
          {"a.xyz", text},
          {"a.pts", "3\n" + text},
          {"a.obj", "v 1 2 3\nv 4 5 6\nv 7 8 9\nf 1 2 3\n"},
          {"a.off", "OFF\n3 1 0\n" + text + "3 0 1 2\n"}};
}

// A file cut after any of its bytes is refused or, where its format cannot tell, holds fewer
// points; never a point that the whole does not have.
TEST(BadCloudBytes, NoPhantomPointsWhereverTheFileIsCut) {
  const TemporaryFolder folder;
  for (const auto& [name, bytes] : whole_files()) {
    EXPECT_EQ(read_cloud(folder.write(name, bytes)).points, kWhole) << name;
    const bool knows_its_end = name != "a.xyz" && name != "a.obj";
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      SCOPED_TRACE(name + " cut to " + std::to_string(size));
      const std::filesystem::path path = folder.write(name, bytes.substr(0, size));
      const bool only_newline_lost = bytes.substr(size) == "\n";
      try {
        const std::vector<Point> points = read_cloud(path).points;
        ASSERT_LE(points.size(), kWhole.size());
        EXPECT_TRUE(std::equal(points.begin(), points.end(), kWhole.begin()));
        EXPECT_TRUE(only_newline_lost || !knows_its_end);
      } catch (const Error& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with(path.string())) << error.what();
        EXPECT_FALSE(only_newline_lost) << error.what();
      }
    }
  }
}

// Whatever a few wrong bytes do, the file is read as finite points or refused with one clear line.
TEST(BadCloudBytes, MutatedFilesAreReadOrRefused) {
  constexpr std::uint64_t kSeed = 31;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  Random random(kSeed);
  const TemporaryFolder folder;
  for (const auto& [name, whole] : whole_files()) {
    int refused = 0;
    for (int i = 0; i < 1500; ++i) {
      std::string bytes = whole;
      for (std::uint32_t change = random.below(3) + 1; change-- != 0;) {
        const std::size_t at = random.below(bytes.size());
        const char byte = random.below(2) == 0 ? static_cast<char>(random.below(256))
                                               : "0123456789 -.e\n,;/#"[random.below(19)];
        switch (random.below(3)) {
          case 0:
            bytes[at] = byte;
            break;
          case 1:
            bytes.insert(at, 1 + random.below(12), byte);
            break;
          default:
            bytes.erase(at, 1 + random.below(4));
            bytes += bytes.empty() ? "\n" : "";
        }
      }
      const std::filesystem::path path = folder.write(name, bytes);
      try {
        const PointCloud cloud = read_cloud(path);
        EXPECT_FALSE(cloud.points.empty());
        EXPECT_LE(cloud.points.size(), bytes.size() / 5);
        for (const Point& p : cloud.points) EXPECT_TRUE(p.allFinite());
      } catch (const Error& error) {
        ++refused;
        expect_clear(error.what(), path.string() + ": ", "", "");
      }
    }
    EXPECT_GT(refused, 100) << name;
    EXPECT_LT(refused, 1500) << name;
  }
}

}  // namespace
}  // namespace emax::test
