// LAS, LAZ, E57 and PTX made by hand. foreign_clouds_test.py has files that other software wrote.

#include "host/files/cloud_file.h"
#include "host/scan_crates/scan_crates.h"
#include "sw_model/base/deliberate_fault.h"
#include "tests/support/messages.h"
#include "tests/support/scan_bytes.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

using Indices = std::vector<std::uint32_t>;

constexpr std::string_view kTurned =
    "1 2 3\n0 1 0\n-1 0 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n1 2 3 1\n";
constexpr std::string_view kAtOrigin =
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

std::string ptx(std::string_view counts, std::string_view pose, std::string_view cells) {
  return std::string(counts) + std::string(pose) + std::string(cells);
}

class ScanFile : public testing::Test {
 protected:
  PointCloud read(std::string_view name, std::string_view bytes, CloudReadOptions options = {}) {
    return read_cloud(folder_.write(name, bytes), options);
  }
  void expect_refused(std::string_view name, std::string_view bytes, std::string_view fault,
                      std::string_view remedy) {
    const std::filesystem::path path = folder_.write(name, bytes);
    SCOPED_TRACE(fault);
    expect_clear(message_of([&] { read_cloud(path); }), path.string() + ": ", fault, remedy);
  }
  TemporaryFolder folder_;
};

TEST_F(ScanFile, PtxTurnsAndShiftsEachScanAndLeavesEmptyCellsOut) {
  const std::string text =
      ptx("2\n2\n", kTurned, "1 0 0 0.5\n0 0 0 0.5\n0 0.25 7 1\n-1 0 0 0\n") +
      ptx("1\n3\n", kAtOrigin, "5 6 7 0.5 1 2 3\n0 0 0 0 0 0 0\nnan 1 2 0 0 0 0\n");
  const CloudReadOptions skip = {.skip_invalid = true};
  const PointCloud cloud = read("a.ptx", text, skip);
  EXPECT_EQ(cloud.points, (std::vector<Point>{{1, 3, 3}, {0.75, 2, 10}, {1, 1, 3}, {5, 6, 7}}));
  EXPECT_EQ(cloud.file_index, (Indices{0, 2, 3, 4}));
  ASSERT_EQ(cloud.scans.size(), 2u);
  EXPECT_EQ(cloud.scans[0].begin, 0u);
  EXPECT_EQ(cloud.scans[1].begin, 3u);
  EXPECT_EQ(describe(cloud.left_out), "2 empty cells, 1 not finite");
  EXPECT_EQ(cloud.resolution, 0);
  expect_refused("b.ptx", text, "line 27: a coordinate is NaN", "--skip-invalid");
}

TEST_F(ScanFile, PtxBeginsOfScansFollowTheirPointsWherePointsAreLeftOut) {
  const std::string text = ptx("1\n2\n", kAtOrigin, "nan 0 1 0\n1 2 3 0\n") +
                           ptx("1\n1\n", kAtOrigin, "nan 0 1 0\n") +
                           ptx("1\n1\n", kAtOrigin, "4 5 6 0\n");
  const PointCloud cloud = read("a.ptx", text, {.skip_invalid = true});
  EXPECT_EQ(cloud.file_index, (Indices{1, 3}));
  ASSERT_EQ(cloud.scans.size(), 3u);
  EXPECT_EQ(cloud.scans[1].begin, 1u);
  EXPECT_EQ(cloud.scans[2].begin, 1u);
}

TEST_F(ScanFile, PtxCountsRoundedPosesInItsResolution) {
  const std::string pose =
      "0 0 0\n1 0 0\n0 1 0\n0 0 1\n0.866025 0.5 0 0\n-0.5 0.866025 0 0\n0 0 1 0\n0 0 0 1\n";
  const PointCloud cloud = read("a.ptx", ptx("1\n1\n", pose, "100 0 0 0\n"));
  EXPECT_GT(cloud.resolution, 1e-5);
  EXPECT_LT(cloud.resolution, 1e-3);
}

TEST_F(ScanFile, PtxRefusesWhatContradictsItsFormat) {
  const std::string one = "1 2 3 0\n";
  expect_refused("a.ptx", "1 2 3\n", "the number of columns must stand alone", "export");
  expect_refused("a.ptx", "2\n", "where the number of rows must follow", "export");
  expect_refused("a.ptx", ptx("1\n2\n", kAtOrigin, "1.0000000000 2 3 0\n"),
                 "where cell 1 of 2 must follow", "export");
  expect_refused("a.ptx", ptx("1\n1\n", kAtOrigin, one + one), "line 12: the number of columns",
                 "export");
  expect_refused("a.ptx", ptx("4000000000\n4000000000\n", kAtOrigin, one),
                 "4000000000 x 4000000000 cells are promised", "export");
  expect_refused("a.ptx", ptx("1\n2\n", kAtOrigin, "1 2 3 0\n1 2 3 0 0 0 0\n"),
                 "line 12: 7 columns", "export");
  expect_refused("a.ptx", ptx("1\n1\n", kAtOrigin, "1 2 3 x\n"), "line 11: \"x\"", "correct");
  expect_refused("a.ptx", ptx("1\n1\n", kAtOrigin, "0 0 0 0\n"),
                 "every point is left out: 1 empty cells", "check");
  expect_refused("a.ptx", ptx("0\n0\n", kAtOrigin, ""), "holds no points", "export");
}

TEST_F(ScanFile, PtxRefusesPosesThatAreNoRotations) {
  const std::string axes = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  for (const std::string_view pose :
       {"2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n", "1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1\n",
        "1 0.1 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", "0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 1\n",
        "nan 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 inf 0 1\n"}) {
    expect_refused("a.ptx", ptx("1\n1\n", axes + std::string(pose), "1 2 3 0\n"),
                   "line 10: the pose above is not a rotation", "rigid poses");
  }
  expect_refused("a.ptx",
                 ptx("1\n1\n", axes + "1 0 0 0\n0 1 0 0.5\n0 0 1 0\n0 0 0 1\n", "1 2 3 0\n"),
                 "line 8: the pose is not a rotation", "rigid poses");
}

TEST_F(ScanFile, LasScalesShiftsAndLeavesClassesOut) {
  const std::string bytes = las_bytes({{0, 0, 0, 2}, {100, -7, 1, 0x40 | 7}, {5, 6, 7, 31}});
  const PointCloud cloud = read("a.las", bytes);
  EXPECT_EQ(cloud.points, (std::vector<Point>{{1, 2, 3},
                                              {100 * 0.01 + 1, -7 * 0.01 + 2, 1 * 0.01 + 3},
                                              {5 * 0.01 + 1, 6 * 0.01 + 2, 7 * 0.01 + 3}}));
  EXPECT_TRUE(cloud.file_index.empty());
  EXPECT_FALSE(cloud.unit);
  const PointCloud left = read("a.LAS", bytes, {.left_out_classes = {7}});
  EXPECT_EQ(left.file_index, (Indices{0, 2}));
  EXPECT_EQ(describe(left.left_out), "1 of class 7");
  const auto all = folder_.write("b.las", bytes);
  expect_clear(message_of([&] {
                 read_cloud(all, {.left_out_classes = {2, 7, 31}});
               }),
               all.string(), "every point is left out", "check");
  const auto text = folder_.write("b.xyz", "1 2 3\n");
  expect_clear(message_of([&] { read_cloud(text, {.left_out_classes = {2}}); }), text.string(),
               "only LAS and LAZ files have classes", "leave");
}

TEST_F(ScanFile, LasOverflowIsNotFinite) {
  std::string bytes = las_bytes({{0, 0, 0, 0}, {2000000000, 0, 0, 0}});
  put(bytes, 131, 1e300);
  expect_refused("a.las", bytes, "point 1: a coordinate is NaN or infinite", "--skip-invalid");
}

// One point, and this record of its reference system.
std::string las_with_record(std::uint16_t kind, std::string_view content) {
  std::string record(54, '\0');
  record.replace(2, 15, "LASF_Projection");
  put(record, 18, kind);
  put(record, 20, static_cast<std::uint16_t>(content.size()));
  record += content;
  std::string bytes = las_bytes({{0, 0, 0, 0}});
  bytes.insert(227, record);
  put(bytes, 96, static_cast<std::uint32_t>(227 + record.size()));
  put(bytes, 100, std::uint32_t{1});
  return bytes;
}

std::string las_with_keys(std::initializer_list<std::pair<int, int>> keys) {
  std::string content(8 + 8 * keys.size(), '\0');
  std::size_t at = 8;
  for (const auto& [key, value] : keys) {
    put(content, at, static_cast<std::uint16_t>(key));
    put(content, at + 6, static_cast<std::uint16_t>(value));
    at += 8;
  }
  return las_with_record(34735, content);
}

TEST_F(ScanFile, LasNamesTheUnitOfItsKeys) {
  for (const auto& [code, unit] : {std::pair(9001, "m"), std::pair(9002, "ft"),
                                   std::pair(9003, "us-ft"), std::pair(9999, "")}) {
    std::string bytes = las_with_keys({{1024, 1}, {3076, code}, {4099, code}});
    EXPECT_EQ(read("a.las", bytes).unit, unit_named(unit));
    put(bytes, 227 + 20, std::uint16_t{33});
    expect_refused("a.las", bytes, "record 0 ends behind", "export");
  }
  EXPECT_EQ(read("a.las", las_with_keys({{3076, 9003}, {4099, 9999}})).unit, unit_named("us-ft"));
  expect_refused("a.las", las_with_keys({{1024, 2}}), "longitudes and latitudes", "project");
  expect_refused("a.las", las_with_keys({{3076, 9003}, {4099, 9001}}),
                 "its heights are in m, but the rest is in us-ft", "convert");
}

TEST_F(ScanFile, LasNamesTheUnitOfItsText) {
  const std::string round =
      R"(GEOGCS["NAD83",DATUM["D",SPHEROID["GRS 1980",6378137,298.257222101]],)"
      R"(PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]])";
  const auto flat = [&](std::string_view unit) {
    return R"(PROJCS["New York [Long Island], PROJCS[",)" + round +
           R"(,PROJECTION["Lambert"],PARAMETER["false_easting",984250],)" + std::string(unit) +
           R"(,AXIS["X",EAST],AUTHORITY["EPSG","2263"]])";
  };
  const auto unit_of = [&](const std::string& text) {
    return read("a.las", las_with_record(2112, text)).unit;
  };
  EXPECT_EQ(unit_of(flat(R"(UNIT["metre",1])")), unit_named("m"));
  EXPECT_EQ(unit_of(flat(R"(UNIT["foot",0.3048,AUTHORITY["EPSG","9002"]])")), unit_named("ft"));
  for (const char* const foot : {"0.3048006096", "0.304800609601219", "0.30480061"}) {
    EXPECT_EQ(unit_of(flat(R"(Unit [ "US survey foot", )" + std::string(foot) + " ]")),
              unit_named("us-ft"));
  }
  EXPECT_EQ(unit_of(flat(R"(UNIT["rod",5.0292])")), std::nullopt);
  const auto both = [&](std::string_view heights) {
    return R"(COMPD_CS["both",)" + flat(R"(UNIT["metre",1])") + R"(,VERT_CS["NAVD88",)" +
           std::string(heights) + R"(,AXIS["Up",UP]]])";
  };
  EXPECT_EQ(unit_of(both(R"(UNIT["metre",1.0])")), unit_named("m"));
  // Version 2 of the text, where a unit may be said of each axis.
  EXPECT_EQ(unit_of(R"(PROJCRS["UTM",BASEGEOGCRS["WGS 84"],CONVERSION["16N",)"
                    R"(PARAMETER["x",500,LENGTHUNIT["kilometre",1000]]],CS[Cartesian,2],)"
                    R"(AXIS["E",east,LENGTHUNIT["foot",0.3048]],AXIS["N",north]])"),
            unit_named("ft"));
  for (const char* const text : {"", "]]))", "UNIT[", "PROJCS[\"a", "PROJCS[UNIT]", "PROJCS,2"}) {
    EXPECT_EQ(unit_of(text), std::nullopt) << text;
  }
  expect_refused("a.las", las_with_record(2112, round), "longitudes and latitudes", "project");
  expect_refused("a.las", las_with_record(2112, both(R"(UNIT["foot",0.3048])")),
                 "its heights are in ft, but the rest is in m", "convert");
}

TEST_F(ScanFile, LasLeavesWithheldPointsOut) {
  std::string bytes = las_bytes({{0, 0, 0, 2}, {1, 0, 0, 0x80 | 2}, {2, 0, 0, 0x60 | 2}});
  const PointCloud cloud = read("a.las", bytes);
  EXPECT_EQ(cloud.file_index, (Indices{0, 2}));
  EXPECT_EQ(describe(cloud.left_out), "1 withheld");
  bytes[25] = 0;  // LAS 1.0 has no such flag
  EXPECT_EQ(read("a.las", bytes).points.size(), 3u);
}

TEST_F(ScanFile, LazIsReadAsItsWriterReadsIt) {
  for (const char* name :
       {"written_by_laspy_2.7_format_1.laz", "written_by_laspy_2.7_format_7.laz"}) {
    const PointCloud cloud = read_cloud(std::filesystem::path(EMAX_TEST_DATA) / name);
    ASSERT_EQ(cloud.points.size(), 5u) << name;
    for (int i = 0; i < 5; ++i) {
      const Point expected(7 * i * 0.01 + 1, i * i * 0.01 + 2, -i * 0.01 + 3);
      EXPECT_EQ(cloud.points[static_cast<std::size_t>(i)], expected) << name;
    }
  }
}

TEST_F(ScanFile, EveryCutLazIsRefused) {
  const std::string whole =
      bytes_of(std::filesystem::path(EMAX_TEST_DATA) / "written_by_laspy_2.7_format_1.laz");
  for (std::size_t size = 1; size < whole.size(); ++size) {
    const auto path = folder_.write("a.laz", whole.substr(0, size));
    expect_clear(message_of([&] { read_cloud(path); }), path.string() + ": ", "", "");
  }
}

TEST_F(ScanFile, E57AppliesThePoseAndLeavesInvalidPointsOut) {
  const PointCloud cloud = read("a.e57", e57_pages(e57_content()));
  ASSERT_EQ(cloud.points.size(), 3u);
  const std::vector<Point> expected{{1, 2, 3}, {1, 3, 3}, {0, 2, 3}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT((cloud.points[i] - expected[i]).norm(), 1e-15);
  }
  EXPECT_EQ(describe(cloud.left_out), "1 marked as invalid");
  EXPECT_EQ(cloud.unit, unit_named("m"));
  ASSERT_EQ(cloud.scans.size(), 1u);
  EXPECT_EQ(cloud.scans[0].name, "north");
  EXPECT_NEAR(cloud.resolution, 0.005 * std::sqrt(3), 1e-15);
}

TEST_F(ScanFile, E57RefusesPosesThatAreNoRotationsAndWrongChecksums) {
  expect_refused("a.e57", e57_pages(e57_content("0.8")), "the pose of scan \"north\" is not",
                 "rigid poses");
  const std::string whole = e57_pages(e57_content());
  for (const std::size_t at : {100u, 1023u, 1100u}) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 4);
    expect_refused("a.e57", bytes, "the checksum of page", "export");
  }
  for (std::size_t size = 1; size < whole.size(); size += 13) {
    const auto path = folder_.write("a.e57", whole.substr(0, size));
    expect_clear(message_of([&] { read_cloud(path); }), path.string() + ": ", "", "");
  }
}

TEST(ScanCrates, APanicIsAnError) {
  EXPECT_THROW(panic_in_crates(), CrateRefusal);
  EXPECT_EQ(message_of([] { panic_in_crates(); }), "its content is contradictory");
}

TEST(ScanFileFault, PointsMarkedAsInvalidAreMissed) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.e57", e57_pages(e57_content()));
  EXPECT_EQ(read_cloud(path).points.size(), 3u);
  const DeliberateFault fault(Fault::kKeepsInvalid);
  EXPECT_EQ(read_cloud(path).points.size(), 4u);
}

}  // namespace
}  // namespace emax::test
