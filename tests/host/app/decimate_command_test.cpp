// `emax decimate` as a person sees it, and what `emax verify` makes of its certificates.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "host/decimate/feature_edges.h"
#include "host/files/cloud_file.h"
#include "host/files/mesh_file.h"
#include "host/files/sha256.h"
#include "host/geometry/bounds.h"
#include "host/geometry/mesh_validity.h"
#include "sw_model/certify/certificate.h"
#include "sw_model/certify/surface_distance.h"
#include "tests/host/app/program.h"
#include "tests/host/support/surfaces.h"
#include "tests/support/stimuli.h"
#include "tests/support/temporary_folder.h"

namespace emax {
namespace {

using nlohmann::json;
using test::ProgramRun;

class DecimateCommand : public testing::Test {
 protected:
  DecimateCommand() {
    test::write_scan(folder_.path() / "scan.xyz", 1500, 2);
    test::write_surface(folder_.path() / "surface.off", 30, 44);
    mesh_ = read_mesh(folder_ / "surface.off");
  }

  ProgramRun emax(const std::vector<std::string>& arguments) {
    return test::run_emax(arguments, folder_.path());
  }
  ProgramRun decimate(const std::string& output, std::vector<std::string> more = {},
                      const std::string& mesh = "surface.off", const std::string& error = "1%") {
    more.insert(more.begin(), {"decimate", mesh, "--max-error", error, "-o", output});
    return emax(more);
  }
  json read(const std::string& name) { return json::parse(test::file_text(folder_ / name)); }
  json certificate(const std::string& mesh) { return read(mesh + ".certificate.json"); }
  int verify(const std::string& mesh) {
    return emax({"verify", mesh + ".certificate.json"}).exit_code;
  }

  static double distance(const TriangleMesh& from, const TriangleMesh& to) {
    return surface_distance(from.view(), ExactMesh(to.view())).lower;
  }

  test::TemporaryFolder folder_;
  TriangleMesh mesh_;
};

TEST_F(DecimateCommand, BoundsBothSurfacesAndVerifyAgrees) {
  const ProgramRun run = decimate("out.ply", {"--json", "r.json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const json c = certificate("out.ply"), result = read("r.json");
  const TriangleMesh out = read_mesh(folder_ / "out.ply");
  const double epsilon = c.at("epsilon");
  EXPECT_NEAR(epsilon, bounds_of(mesh_.vertices).width() / 100, 1e-12);
  EXPECT_LT(out.triangles.size(), mesh_.triangles.size() / 2);
  EXPECT_TRUE(check_mesh(out.view()).valid());
  const json& reference = c.at("reference");
  EXPECT_EQ(c.at("bound"), "two-sided");
  EXPECT_EQ(reference.at("file"), "surface.off");
  EXPECT_LE(certify(mesh_.vertices, out.view()).e_max_lower, c.at("e_max").get<double>());
  EXPECT_LE(distance(out, mesh_), reference.at("mesh_to_reference").get<double>());
  EXPECT_LE(distance(mesh_, out), reference.at("reference_to_mesh").get<double>());
  for (const json& bounded :
       {c.at("e_max"), reference.at("mesh_to_reference"), reference.at("reference_to_mesh")}) {
    EXPECT_LE(bounded.get<double>(), epsilon);
    EXPECT_GT(bounded.get<double>(), epsilon / 4);
  }
  for (const char* key : {"e_max", "epsilon", "e_max_squared_bits", "worst_point", "triangles",
                          "valid", "transform", "bound", "reference", "topology"}) {
    EXPECT_EQ(result.at(key), c.at(key)) << key;
  }
  EXPECT_EQ(verify("out.ply"), 0);
  EXPECT_EQ(test::files_in(folder_.path()).size(), 5u);
}

// A cube of 16 x 16 squares a side, its vertices off the sides by up to 0.4 % of the width.
TriangleMesh rough_cube() {
  TriangleMesh mesh = test::cube(16);
  Random random(named_seed("rough cube", 1));
  for (Point& v : mesh.vertices) v += random.point(-0.008, 0.008);
  return mesh;
}

TEST_F(DecimateCommand, PutsVerticesOnPlanesAndNamesTheirTriangles) {
  write_mesh(folder_ / "cube.ply", rough_cube());
  for (const std::string output : {"out.ply", "out.obj", "out.glb"}) {
    SCOPED_TRACE(output);
    const ProgramRun run =
        decimate(output, {"--features", "planes", "--json", "r.json"}, "cube.ply", "2%");
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_NE(run.output.find("6 found"), std::string::npos) << run.output;
    const json regions = read("r.json").at("regions");
    ASSERT_EQ(regions.size(), 6u);
    const TriangleMesh out = read_mesh(folder_ / output);
    std::size_t triangles = 0;
    double area = 0;
    for (const json& region : regions) {
      triangles += region.at("triangles").get<std::size_t>();
      area += region.at("area").get<double>();
      EXPECT_GT(region.at("points"), 100);
      EXPECT_LT(region.at("rms"), 0.008);
    }
    EXPECT_EQ(triangles, out.triangles.size());
    EXPECT_EQ(triangles, 12u);
    EXPECT_NEAR(area, 24, 0.2);
    EXPECT_EQ(verify(output), 0);
  }
  EXPECT_NE(test::file_text(folder_ / "out.obj").find("g plane_1\n"), std::string::npos);
}

TEST_F(DecimateCommand, PutsVerticesOnCylindersToo) {
  write_mesh(folder_ / "can.ply", test::can(80, 24));
  const ProgramRun run =
      decimate("out.obj", {"--features", "all", "--json", "r.json"}, "can.ply", "1%");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const json regions = read("r.json").at("regions");
  ASSERT_EQ(regions.size(), 3u);
  EXPECT_EQ(regions[2].at("kind"), "cylinder");
  EXPECT_EQ(regions[2].at("name"), "cylinder_3");
  EXPECT_NEAR(regions[2].at("radius").get<double>(), 1, 1e-6);
  const TriangleMesh out = read_mesh(folder_ / "out.obj");
  std::size_t triangles = 0;
  for (const json& region : regions) triangles += region.at("triangles").get<std::size_t>();
  EXPECT_EQ(triangles, out.triangles.size());
  for (const Point& v : out.vertices) {
    const bool on_side = std::abs(std::hypot(v.x(), v.y()) - 1) < 1e-6;
    EXPECT_TRUE(on_side || std::abs(std::abs(v.z()) - 1) < 1e-6);
  }
  EXPECT_NE(test::file_text(folder_ / "out.obj").find("g cylinder_3\n"), std::string::npos);
  EXPECT_NE(run.output.find("radius 1, axis"), std::string::npos) << run.output;
  EXPECT_EQ(verify("out.obj"), 0);
}

TEST_F(DecimateCommand, AutoTakesTheFewerTriangles) {
  write_mesh(folder_ / "cube.ply", rough_cube());
  std::map<std::string, std::size_t> triangles;
  for (const std::string features : {"none", "planes", "auto"}) {
    ASSERT_EQ(decimate(features + ".ply", {"--features", features}, "cube.ply", "1%").exit_code, 0);
    triangles[features] = read_mesh(folder_ / (features + ".ply")).triangles.size();
  }
  EXPECT_LE(triangles["auto"], std::min(triangles["none"], triangles["planes"]));
  EXPECT_EQ(decimate("t.ply", {"--features", "auto", "--tiles", "100"}).exit_code, 1);
}

// A plate of 41 x 41 vertices without one of them, and without a window of 0.3 x 0.3.
TriangleMesh plate_with_a_window() {
  TriangleMesh plate = test::sheet(41, 0);
  std::erase_if(plate.triangles, [&](const Triangle& t) {
    return std::ranges::any_of(t, [&](std::uint32_t v) {
      const bool in_window = (plate.vertices[v] - Point(0.5, 0, 0)).cwiseAbs().maxCoeff() < 0.11;
      return in_window || (plate.vertices[v] - Point(-0.5, 0, 0)).norm() < 1e-9;
    });
  });
  return plate;
}

TEST_F(DecimateCommand, ClosesFlatHolesBelowTheToleranceAndWiderOnesOnDemand) {
  write_mesh(folder_ / "plate.ply", plate_with_a_window());
  const auto borders = [&](std::vector<std::string> more) {
    const ProgramRun run = decimate("out.ply", std::move(more), "plate.ply", "3%");
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_EQ(verify("out.ply"), 0);
    return certificate("out.ply").at("topology").at("border_loops").get<int>();
  };
  EXPECT_EQ(borders({}), 3);
  EXPECT_EQ(borders({"--features", "planes"}), 2);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out.ply.reference.ply"));
  EXPECT_EQ(borders({"--features", "planes", "--hole-reach", "10%"}), 1);
  EXPECT_EQ(borders({"--features", "planes", "--hole-reach", "none"}), 3);
  const ProgramRun alone = decimate("no.ply", {"--hole-reach", "10%"}, "plate.ply", "3%");
  EXPECT_EQ(alone.exit_code, 1);
  EXPECT_NE(alone.errors.find("--features"), std::string::npos) << alone.errors;
}

TEST_F(DecimateCommand, KeepsTheCornersOfAPartSharp) {
  const std::string part = "part.off";
  std::filesystem::copy_file(EMAX_DATA_FOLDER "/fandisk.off", folder_ / part);
  const auto corners_left = [&](const std::string& output, std::vector<std::string> more) {
    EXPECT_EQ(decimate(output, std::move(more), part, "1%").exit_code, 0);
    const std::vector<Point> kept = read_mesh(folder_ / output).vertices;
    const TriangleMesh mesh = read_mesh(folder_ / part);
    const FeatureEdges features(mesh, 40);
    std::size_t corners = 0, left = 0;
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      if (features.vertex_class(v) != VertexClass::kCorner) continue;
      ++corners;
      left += std::ranges::find(kept, mesh.vertices[v]) != kept.end() ? 1 : 0;
    }
    EXPECT_GT(corners, 10u);
    return static_cast<double>(left) / static_cast<double>(corners);
  };
  EXPECT_EQ(corners_left("sharp.ply", {"--feature-angle", "40"}), 1);
  EXPECT_LT(corners_left("any.ply", {}), 0.5);
  EXPECT_EQ(certificate("sharp.ply").at("parameters").at("bounded.feature_angle"), 40);
  EXPECT_EQ(verify("sharp.ply"), 0);
  EXPECT_NE(decimate("no.ply", {"--feature-angle", "200"}).exit_code, 0);
}

TEST_F(DecimateCommand, SeveralTolerancesGiveACertifiedMeshEach) {
  const ProgramRun run =
      decimate("part.ply", {"--json", "curve.json"}, "surface.off", "2%,0.5%,1%");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  std::size_t last = mesh_.triangles.size();
  const json curve = read("curve.json")["curve"];
  ASSERT_EQ(curve.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string name = std::array{"part-0.5pct.ply", "part-1pct.ply", "part-2pct.ply"}[i];
    EXPECT_EQ(verify(name), 0) << name;
    const std::size_t triangles = read_mesh(folder_ / name).triangles.size();
    EXPECT_LT(triangles, last) << name;
    last = triangles;
    EXPECT_EQ(curve[i]["mesh"], name);
    EXPECT_EQ(curve[i]["triangles"], triangles);
    EXPECT_LE(curve[i]["e_max"], curve[i]["epsilon"]);
    EXPECT_NE(run.output.find(name), std::string::npos);
  }
  EXPECT_NE(test::file_text(folder_ / "part-curve.svg").find("</svg>"), std::string::npos);
}

TEST_F(DecimateCommand, ALevelOfAccuracyIsATolerance) {
  const std::vector<std::string> decimate = {"decimate", "surface.off", "-o",
                                             "out.ply",  "--unit",      "m"};
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.begin(), decimate.begin(), decimate.end());
    return emax(more);
  };
  const ProgramRun done = run({"--loa", "30"});
  ASSERT_EQ(done.exit_code, 0) << done.errors;
  EXPECT_NE(done.output.find("LOA 30, as a maximum"), std::string::npos) << done.output;
  EXPECT_EQ(certificate("out.ply").at("epsilon"), 0.015);
  EXPECT_EQ(run({"--loa", "30", "--max-error", "1"}).exit_code, 1);
  EXPECT_EQ(run({}).exit_code, 1);
}

TEST_F(DecimateCommand, SeveralTolerancesThatMakeNoSenseAreRefused) {
  for (const char* wrong : {"1%,", ",1%", "1%,1%", "1%,x", "1%,-2%"}) {
    EXPECT_EQ(decimate("part.ply", {}, "surface.off", wrong).exit_code, 1) << wrong;
  }
  const ProgramRun run = decimate("part.ply", {"--exclude-outliers", "1%"}, "surface.off", "1%,2%");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.errors.find("give one --max-error"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "part-1pct.ply"));
}

TEST_F(DecimateCommand, HoppesEnergyIsLoweredWithinTheBound) {
  ASSERT_EQ(decimate("fewest.ply", {}).exit_code, 0);
  ASSERT_EQ(decimate("hoppe.ply", {"--objective", "hoppe"}).exit_code, 0);
  EXPECT_EQ(verify("hoppe.ply"), 0);
  EXPECT_GT(read_mesh(folder_ / "hoppe.ply").triangles.size(),
            read_mesh(folder_ / "fewest.ply").triangles.size());
  EXPECT_EQ(certificate("hoppe.ply")["parameters"]["bounded.hoppe"], 1);
  EXPECT_FALSE(certificate("fewest.ply")["parameters"].contains("bounded.hoppe"));
}

TEST_F(DecimateCommand, KeepsToTheCloudThatIsGiven) {
  for (const std::string bound : {"one-sided", "two-sided"}) {
    ASSERT_EQ(decimate("out.off", {"--cloud", "scan.xyz", "--bound", bound}).exit_code, 0);
    const json c = certificate("out.off");
    EXPECT_EQ(c.at("bound"), bound);
    EXPECT_EQ(c.at("points"), 1500);
    const TriangleMesh out = read_mesh(folder_ / "out.off");
    EXPECT_TRUE(certify(read_cloud(folder_ / "scan.xyz").points, out.view())
                    .within(c.at("epsilon").get<double>()));
    EXPECT_EQ(verify("out.off"), 0);
  }
  const TriangleMesh out = read_mesh(folder_ / "out.off");
  EXPECT_LE(distance(mesh_, out),
            certificate("out.off").at("reference").at("reference_to_mesh").get<double>());
  ASSERT_EQ(decimate("loose.off", {"--cloud", "scan.xyz", "--back-error", "3%"}).exit_code, 0);
  const json loose = certificate("loose.off");
  EXPECT_NEAR(loose.at("reference").at("epsilon_back").get<double>(),
              3 * loose.at("epsilon").get<double>(), 1e-12);
  EXPECT_EQ(verify("loose.off"), 0);
}

TEST_F(DecimateCommand, EveryFormatIsCertifiedAsItIsStored) {
  for (const std::string name : {"out.obj", "out.off", "out.stl"}) {
    ASSERT_EQ(decimate(name, {"--effort", "quick"}).exit_code, 0) << name;
    EXPECT_EQ(certificate(name).at("valid"), true);
    EXPECT_EQ(verify(name), 0) << name;
  }
  // And from STL, which repeats its vertices.
  ASSERT_EQ(decimate("again.ply", {"--effort", "quick"}, "out.stl", "3%").exit_code, 0);
  EXPECT_EQ(verify("again.ply"), 0);
}

TEST_F(DecimateCommand, AShortOptionTakesItsValueBehindAnEqualsSign) {
  ASSERT_EQ(
      emax({"decimate", "surface.off", "--max-error=3%", "--effort=quick", "-o=out.ply"}).exit_code,
      0);
  EXPECT_EQ(verify("out.ply"), 0);
}

TEST_F(DecimateCommand, InTilesKeepsAllBoundsForAnyNumberOfThreads) {
  const std::vector<std::string> tiles = {"--tiles", "1000", "--json", "r.json"};
  const ProgramRun run = decimate("one.ply", tiles);
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_NE(run.output.find("so far         one.ply: "), std::string::npos) << run.output;
  EXPECT_EQ(verify("one.ply"), 0);
  const TriangleMesh result = read_mesh(folder_ / "one.ply");
  EXPECT_TRUE(check_mesh(result.view()).valid());
  EXPECT_EQ(check_mesh(result.view()).components, check_mesh(mesh_.view()).components);
  std::vector<std::string> threads = tiles;
  threads.insert(threads.end(), {"--threads", "3"});
  ASSERT_EQ(decimate("two.ply", threads).exit_code, 0);
  EXPECT_EQ(test::file_text(folder_ / "one.ply"), test::file_text(folder_ / "two.ply"));
}

// With invalid points, which have numbers in the file alone.
TEST_F(DecimateCommand, PointsThatAreNotInMemoryGiveTheSameBytes) {
  std::ofstream(folder_ / "more.xyz")
      << "nan 0 0\n"
      << test::file_text(folder_ / "scan.xyz") << "1 nan 1\n0.3 0.2 2.5\n";
  std::vector<std::string> arguments = {"--cloud", "more.xyz", "--skip-invalid",
                                        "--tiles", "1000",     "--exclude-outliers",
                                        "2%",      "--effort", "quick"};
  const ProgramRun whole = decimate("out.ply", arguments);
  ASSERT_EQ(whole.exit_code, 0) << whole.errors;
  const std::string mesh = test::file_text(folder_ / "out.ply");
  const std::string claims = test::file_text(folder_ / "out.ply.certificate.json");
  const std::vector<std::string> files = test::files_in(folder_.path());
  arguments.insert(arguments.end(), {"--memory", "90KB"});
  const ProgramRun pieces = decimate("out.ply", arguments);
  ASSERT_EQ(pieces.exit_code, 0) << pieces.errors;
  EXPECT_EQ(test::file_text(folder_ / "out.ply"), mesh);
  EXPECT_EQ(test::file_text(folder_ / "out.ply.certificate.json"), claims);
  EXPECT_EQ(test::files_in(folder_.path()), files) << "files of tiles are left";
  EXPECT_EQ(verify("out.ply"), 0);
}

TEST_F(DecimateCommand, PointsThatAreNotInMemoryNeedTilesAndAFolder) {
  const std::vector<std::string> pieces = {"--cloud", "scan.xyz",           "--memory",
                                           "90KB",    "--exclude-outliers", "2%"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), pieces.begin(), pieces.end());
    return decimate("out.ply", more);
  };
  EXPECT_NE(with({"--report", "r.html"}).errors.find("--report"), std::string::npos);
  EXPECT_NE(with({"--objective", "hoppe"}).errors.find("--memory"), std::string::npos);
  std::filesystem::create_directory(folder_ / "own");
  std::ofstream(folder_ / "own" / "letter.txt") << "keep me";
  const ProgramRun refused = with({"--tile-folder", "own"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.errors.find("--tile-folder"), std::string::npos) << refused.errors;
  EXPECT_EQ(test::file_text(folder_ / "own" / "letter.txt"), "keep me");
  EXPECT_FALSE(exists(folder_ / "out.ply"));
  const ProgramRun made = with({"--tile-folder", "new"});
  EXPECT_EQ(made.exit_code, 0) << made.output << made.errors;
  EXPECT_FALSE(exists(folder_ / "new"));
}

TEST_F(DecimateCommand, SameInputSameBytes) {
  ASSERT_EQ(decimate("one.ply").exit_code, 0);
  ASSERT_EQ(decimate("two.ply").exit_code, 0);
  EXPECT_EQ(test::file_text(folder_ / "one.ply"), test::file_text(folder_ / "two.ply"));
}

TEST_F(DecimateCommand, VerifyCatchesEveryFalseClaim) {
  ASSERT_EQ(decimate("out.ply", {"--effort", "quick"}).exit_code, 0);
  const json honest = certificate("out.ply");
  const auto verdict = [&](const auto& change) {
    json claim = honest;
    change(claim, claim["reference"]);
    std::ofstream(folder_ / "claim.json") << claim;
    return emax({"verify", "claim.json"}).exit_code;
  };
  EXPECT_EQ(verdict([](json&, json&) {}), 0);
  for (const char* key : {"mesh_to_reference", "reference_to_mesh", "epsilon_back"}) {
    const double claimed = honest.at("reference").at(key);
    EXPECT_EQ(verdict([&](json&, json& r) { r[key] = claimed / 2; }), 2) << key;
  }
  const TriangleMesh mesh = read_mesh(folder_ / "out.ply");
  const TriangleMesh reference =
      read_mesh(folder_ / honest.at("reference").at("file").get<std::string>());
  struct Claim {
    const char* key;
    const TriangleMesh &from, &to;
  };
  for (const Claim& claim :
       {Claim{"mesh_to_reference", mesh, reference}, Claim{"reference_to_mesh", reference, mesh}}) {
    const double claimed = honest.at("reference").at(claim.key);
    for (const double wrong : {0.97 * distance(claim.from, claim.to), 1.5 * claimed, -claimed}) {
      EXPECT_EQ(verdict([&](json&, json& r) { r[claim.key] = wrong; }), 2) << claim.key << wrong;
    }
  }
  EXPECT_EQ(verdict([](json&, json& r) { r["points_to_reference"] = -1; }), 2);
  EXPECT_EQ(verdict([](json&, json& r) { r["triangles"] = 4; }), 2);
  EXPECT_EQ(verdict([](json&, json& r) { r["sha256"] = "00"; }), 2);
  EXPECT_EQ(verdict([](json& c, json&) { c["e_max"] = 0; }), 2);
  EXPECT_EQ(verdict([](json&, json& r) { r.erase("epsilon_back"); }), 1);
  EXPECT_EQ(verdict([](json&, json& r) { r["file"] = "absent.ply"; }), 1);
  EXPECT_EQ(verdict([](json&, json& r) { r["reference_to_mesh"] = nullptr; }), 1);
  for (const char* key : {"components", "border_loops", "genus"}) {
    EXPECT_EQ(verdict([&](json& c, json&) { c["topology"][key] = 3; }), 2) << key;
    EXPECT_EQ(verdict([&](json&, json& r) { r["topology"][key] = 3; }), 2) << key;
    EXPECT_EQ(verdict([&](json& c, json&) { c["topology"].erase(key); }), 1) << key;
  }

  // A reference with a piece that the mesh lacks: only the way from the reference to the mesh can
  // tell, all else that is said of it is true.
  TriangleMesh more = mesh_;
  const auto first = static_cast<std::uint32_t>(more.vertices.size());
  for (const Point& p : {Point(5, 0, 0), Point(6, 0, 0), Point(5, 1, 0)})
    more.vertices.push_back(p);
  more.triangles.push_back({first, first + 1, first + 2});
  write_mesh(folder_ / "more.off", more);
  const auto with_more = [&](json&, json& r) {
    r["file"] = "more.off";
    r["sha256"] = sha256_of_file(folder_ / "more.off");
    r["triangles"] = more.triangles.size();
    r["topology"] = {{"components", 2}, {"border_loops", 1}, {"genus", 0}};
  };
  EXPECT_EQ(verdict(with_more), 2);
  const ProgramRun run = emax({"verify", "claim.json"});
  EXPECT_NE(run.output.find("for the distance of the reference to the mesh"), std::string::npos);
  EXPECT_EQ(std::ranges::count(run.output, '\n'), 1) << run.output;
}

TEST_F(DecimateCommand, VerifySaysThatAFormerCertificateBoundsLess) {
  ASSERT_EQ(decimate("out.ply", {"--effort", "quick"}).exit_code, 0);
  json former = certificate("out.ply");
  former["schema"] = "emax-certificate-1";
  std::ofstream(folder_ / "claim.json") << former;
  const ProgramRun run = emax({"verify", "claim.json"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.errors.find("before topology and the way from the reference"), std::string::npos)
      << run.errors;
}

// A fin, a hole, a turned triangle, doubled vertices and a second part.
TEST_F(DecimateCommand, ABrokenMeshEndsInAValidOne) {
  TriangleMesh broken = mesh_;
  broken.triangles.erase(broken.triangles.begin() + 200, broken.triangles.begin() + 203);
  std::swap(broken.triangles[7][0], broken.triangles[7][1]);
  const auto vertices = static_cast<std::uint32_t>(broken.vertices.size());
  for (std::uint32_t v = 0; v < vertices; ++v) {
    broken.vertices.push_back(mesh_.vertices[v] + Point(4, 0, 0));
  }
  for (const Triangle& t : mesh_.triangles) {
    broken.triangles.push_back({t[0] + vertices, t[1] + vertices, t[2] + vertices});
  }
  for (std::uint32_t& v : broken.triangles[50]) {
    broken.vertices.push_back(broken.vertices[v]);
    v = static_cast<std::uint32_t>(broken.vertices.size() - 1);
  }
  broken.vertices.push_back(1.01 * mesh_.vertices[99]);
  broken.triangles.push_back({99, 100, static_cast<std::uint32_t>(broken.vertices.size() - 1)});
  write_mesh(folder_ / "broken.ply", broken);
  const ProgramRun run = decimate("out.ply", {"--effort", "quick"}, "broken.ply");
  ASSERT_EQ(run.exit_code, 0) << run.output << run.errors;
  // The fin is cut off, and stays.
  EXPECT_NE(run.output.find("1 non-manifold edge cut apart"), std::string::npos) << run.output;
  const json c = certificate("out.ply");
  EXPECT_EQ(c.at("reference").at("file"), "out.ply.reference.ply");
  EXPECT_EQ(c.at("validity").at("components"), 3);
  EXPECT_EQ(c.at("topology").at("components"), 3);
  EXPECT_EQ(c.at("topology").at("genus"), 0);
  EXPECT_GT(c.at("topology").at("border_loops"), 0);
  EXPECT_GT(c.at("validity").at("boundary_edges"), 0);
  EXPECT_EQ(c.at("valid"), true);
  EXPECT_EQ(verify("out.ply"), 0);

  const ProgramRun repaired =
      decimate("repaired.ply", {"--effort", "quick", "--repair"}, "broken.ply");
  ASSERT_EQ(repaired.exit_code, 0) << repaired.output << repaired.errors;
  EXPECT_NE(repaired.output.find("2 triangles removed"), std::string::npos) << repaired.output;
  EXPECT_EQ(certificate("repaired.ply").at("topology").at("components"), 2);
}

// Two spheres through each other: kept as they are, or without what intersects on demand.
TEST_F(DecimateCommand, KeepsTrianglesThatIntersectUnlessToRepairThem) {
  TriangleMesh crossing = mesh_;
  const auto vertices = static_cast<std::uint32_t>(mesh_.vertices.size());
  for (const Point& p : mesh_.vertices) crossing.vertices.push_back(p + Point(0.7, 0.1, 0.2));
  for (const Triangle& t : mesh_.triangles) {
    crossing.triangles.push_back({t[0] + vertices, t[1] + vertices, t[2] + vertices});
  }
  write_mesh(folder_ / "crossing.ply", crossing);
  const ProgramRun kept = decimate("out.ply", {"--effort", "quick"}, "crossing.ply");
  ASSERT_EQ(kept.exit_code, 0) << kept.output << kept.errors;
  const json c = certificate("out.ply");
  EXPECT_GT(c.at("validity").at("self_intersections"), 0);
  EXPECT_EQ(c.at("topology").at("border_loops"), 0);
  EXPECT_EQ(c.at("topology").at("components"), 2);
  EXPECT_EQ(verify("out.ply"), 0);

  const ProgramRun repaired =
      decimate("repaired.ply", {"--effort", "quick", "--repair"}, "crossing.ply");
  ASSERT_EQ(repaired.exit_code, 0) << repaired.output << repaired.errors;
  EXPECT_EQ(certificate("repaired.ply").at("validity").at("self_intersections"), 0);
  EXPECT_NE(repaired.output.find("repaired  "), std::string::npos) << repaired.output;
  EXPECT_EQ(verify("repaired.ply"), 0);
}

TEST_F(DecimateCommand, ClosesHolesWhereThatIsAskedFor) {
  TriangleMesh open = mesh_;
  const std::uint32_t hole = open.triangles[open.triangles.size() / 2][0];
  std::erase_if(open.triangles,
                [&](const Triangle& t) { return std::ranges::find(t, hole) != t.end(); });
  write_mesh(folder_ / "open.ply", open);
  ASSERT_EQ(decimate("as_given.ply", {"--effort", "quick"}, "open.ply").exit_code, 0);
  EXPECT_EQ(certificate("as_given.ply").at("topology").at("border_loops"), 1);

  const ProgramRun run = decimate("closed.ply", {"--effort", "quick", "--closed"}, "open.ply");
  ASSERT_EQ(run.exit_code, 0) << run.output << run.errors;
  EXPECT_NE(run.output.find("closed         1 hole of the surface"), std::string::npos);
  EXPECT_EQ(certificate("closed.ply").at("topology").at("border_loops"), 0);
  EXPECT_EQ(certificate("closed.ply").at("reference").at("topology").at("border_loops"), 0);
  EXPECT_EQ(verify("closed.ply"), 0);

  // A single triangle has no inside.
  write_mesh(folder_ / "flat.ply", {{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}}, {{0, 1, 2}}});
  const ProgramRun flat = decimate("flat_out.ply", {"--closed"}, "flat.ply");
  EXPECT_EQ(flat.exit_code, 2) << flat.output << flat.errors;
  EXPECT_NE(flat.output.find("left open      a border of 3 edges"), std::string::npos)
      << flat.output;
  EXPECT_EQ(verify("flat_out.ply"), 0);
}

// Stray vertices, which no triangle with an area uses, change neither the task nor the result.
TEST_F(DecimateCommand, VerticesOfNoTriangleAreNoPartOfTheMesh) {
  TriangleMesh stray = mesh_;
  stray.vertices.insert(stray.vertices.end(), {{0, 0, 0}, {1e9, 0.1, 0.1}, {900, 0, 0}});
  const auto last = static_cast<std::uint32_t>(stray.vertices.size() - 1);
  stray.triangles.push_back({0, last, last});
  write_mesh(folder_ / "stray.off", stray);
  for (const std::string name : {"out.ply", "out.stl"}) {
    ASSERT_EQ(decimate(name, {"--effort", "quick"}).exit_code, 0);
    const ProgramRun run = decimate("stray_" + name, {"--effort", "quick"}, "stray.off");
    ASSERT_EQ(run.exit_code, 0) << run.output << run.errors;
    EXPECT_EQ(test::file_text(folder_ / name), test::file_text(folder_ / ("stray_" + name)));
    EXPECT_EQ(certificate(name).at("epsilon"), certificate("stray_" + name).at("epsilon"));
    EXPECT_EQ(certificate(name).at("points"), certificate("stray_" + name).at("points"));
    EXPECT_EQ(verify("stray_" + name), 0);
  }
  ASSERT_EQ(emax({"error", "scan.xyz", "stray.off", "--reference", "surface.off", "--two-sided",
                  "--color-mesh", "colours.ply"})
                .exit_code,
            0);
  EXPECT_EQ(read_mesh(folder_ / "colours.ply").vertices.size(), mesh_.vertices.size() + 1);
}

// A third triangle at an edge, with a vertex far away: the mesh as given does not make the task
// infeasible. Where the triangle is no part of the reference, its vertex is named.
TEST_F(DecimateCommand, IsNeverInfeasibleForAVertexOfItsOwnMesh) {
  TriangleMesh finned = mesh_;
  finned.vertices.push_back({500, 0, 0});
  finned.triangles.push_back({mesh_.triangles[99][0], mesh_.triangles[99][1],
                              static_cast<std::uint32_t>(finned.vertices.size() - 1)});
  write_mesh(folder_ / "finned.off", finned);
  const ProgramRun run = decimate("out.ply", {"--effort", "quick"}, "finned.off", "0.06");
  ASSERT_EQ(run.exit_code, 0) << run.output << run.errors;
  const json c = certificate("out.ply");
  const TriangleMesh result = read_mesh(folder_ / "out.ply");
  const ExactMesh out(result.view());
  std::vector<std::uint32_t> beyond, named;
  for (std::uint32_t v = 0; v < finned.vertices.size(); ++v) {
    if (out.distance(finned.vertices[v]).lower > 0.06) beyond.push_back(v);
  }
  for (const json& point : c.at("excluded")) named.push_back(point.at("point"));
  EXPECT_EQ(beyond, named);
  EXPECT_EQ(run.output.find("left out       vertices of removed triangles: ") != std::string::npos,
            !named.empty())
      << run.output;
  EXPECT_EQ(verify("out.ply"), 0);
}

TEST_F(DecimateCommand, NamesTheAttributesThatTheResultLacks) {
  std::string obj = "mtllib a.mtl\nvt 0 0\n";
  for (const Point& p : mesh_.vertices)
    obj += fmt::format("v {} {} {} 1 0 0\n", p.x(), p.y(), p.z());
  for (const Triangle& t : mesh_.triangles) {
    obj += fmt::format("f {}/1 {}/1 {}/1\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  std::ofstream(folder_ / "painted.obj") << obj;
  const ProgramRun run =
      decimate("out.obj", {"--effort", "quick", "--json", "r.json"}, "painted.obj");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_NE(run.output.find("not kept       materials, texture coordinates, colours: "),
            std::string::npos)
      << run.output;
  EXPECT_EQ(read("r.json").at("lost_attributes"),
            json({"materials", "texture coordinates", "colours"}));
  const ProgramRun plain = decimate("plain.obj", {"--effort", "quick", "--json", "p.json"});
  EXPECT_EQ(plain.output.find("not kept"), std::string::npos) << plain.output;
  EXPECT_EQ(read("p.json").at("lost_attributes"), json::array());
}

// So far that only a sliver would reach it.
TEST_F(DecimateCommand, PointsOutOfReachAreRefusedOrNamed) {
  std::ofstream(folder_ / "scan.xyz", std::ios::app) << "500 0 0\n";
  const auto run = [this](std::vector<std::string> more) {
    more.insert(more.end(), {"--cloud", "scan.xyz", "--effort", "quick"});
    return decimate("out.ply", more, "surface.off", "0.06");
  };
  const ProgramRun refused = run({});
  EXPECT_EQ(refused.exit_code, 2) << refused.errors;
  EXPECT_NE(refused.output.find("point 1500"), std::string::npos) << refused.output;
  EXPECT_EQ(test::files_in(folder_.path()).size(), 2u);
  // Also where the decimator had no time to say so.
  const ProgramRun timed = run({"--time", "0.000001"});
  EXPECT_EQ(timed.exit_code, 2) << timed.errors;
  EXPECT_NE(timed.output.find("point 1500"), std::string::npos) << timed.output;
  ASSERT_EQ(run({"--exclude-outliers", "0.1%"}).exit_code, 0);
  const json c = certificate("out.ply");
  EXPECT_EQ(c.at("excluded").at(0).at("point"), 1500);
  EXPECT_EQ(c.at("points"), 1500);
  EXPECT_EQ(c.at("reference").at("file"), "surface.off");
  EXPECT_EQ(verify("out.ply"), 0);
}

TEST_F(DecimateCommand, RefusesInOneLineAndWritesNothing) {
  std::ofstream(folder_ / "none.off") << "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n";
  std::ofstream(folder_ / "flat.off") << "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n";
  std::ofstream far(folder_ / "far.xyz");
  for (const Point& p : mesh_.vertices) {
    far << fmt::format("{} {} {}\n", 1000 * p.x(), 1000 * p.y(), 1000 * p.z());
  }
  far.close();
  const auto before = test::files_in(folder_.path());
  const auto refused = [&](const ProgramRun& run, const char* text) {
    EXPECT_EQ(run.exit_code, 1) << text;
    EXPECT_NE(run.errors.find(text), std::string::npos) << run.errors;
    EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << run.errors;
    EXPECT_EQ(test::files_in(folder_.path()), before) << text;
  };
  refused(decimate("out.ply", {}, "none.off"), "holds no triangles");
  refused(decimate("out.ply", {}, "flat.off"), "no triangle of any area");
  refused(decimate("out.ply", {}, "absent.off"), "absent.off");
  refused(decimate("out.step"), "out.step");
  refused(decimate("out.ply", {"--cloud", "far.xyz"}), "does not belong");
  refused(decimate("out.ply", {}, "surface.off", "500"), "the unit of the file");
  refused(decimate("out.ply", {}, "surface.off", "0"), "--max-error");
  refused(decimate("out.ply", {}, "surface.off", "1e-13"), "roundings");
  refused(decimate("out.ply", {"--back-error", "x"}), "--back-error x");
  refused(decimate("surface.off"), "surface.off: would be read and replaced");
  refused(decimate("out.ply", {"--cloud", "scan.xyz", "--json", "out.ply.certificate.json"}),
          "out.ply.certificate.json: would be written twice");
  refused(decimate("out.ply", {"--back-error", "1%", "--bound", "one-sided"}), "--back-error");
  refused(decimate("out.ply", {"--effort", "none"}), "quick");
  refused(decimate("out.ply", {"--bound", "both"}), "two-sided");
  refused(decimate("out.ply", {"--tiles", "1000", "--feature-angle", "40"}), "--feature-angle");
  refused(decimate("out.ply", {"--tiles", "1000", "--objective", "hoppe"}), "--objective");
  refused(decimate("out.ply", {"--tiles", "1000"}, "surface.off", "1%,2%"),
          "more than one --max-error");
  refused(decimate("out.ply", {"--tiles", "10"}), "--tiles");
}

TEST_F(DecimateCommand, StoppedItGivesWhatItHas) {
  test::write_surface(folder_ / "surface.off", 100, 150);
  const std::vector<std::string> deep = {"--effort", "deep", "--time", "0.5"};
  const ProgramRun timed = decimate("timed.ply", deep);
  EXPECT_EQ(timed.exit_code, 0) << timed.errors;
  EXPECT_NE(timed.output.find("out of time"), std::string::npos) << timed.output;
  EXPECT_EQ(verify("timed.ply"), 0);
  const ProgramRun stopped = test::run_emax(
      {"decimate", "surface.off", "--max-error", "0.1%", "-o", "out.ply"}, folder_.path(), 1);
  EXPECT_EQ(stopped.exit_code, 130) << stopped.errors;
  if (std::filesystem::exists(folder_ / "out.ply")) {
    EXPECT_EQ(verify("out.ply"), 0);
  }
}

}  // namespace
}  // namespace emax
