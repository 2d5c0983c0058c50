#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/host/app/program.h"
#include "tests/host/support/surfaces.h"
#include "tests/support/board_program.h"
#include "tests/support/stimuli.h"
#include "tests/support/temporary_folder.h"

namespace emax {
namespace {

using nlohmann::json;
using test::ProgramRun;

class EndToEnd : public testing::Test {
 protected:
  EndToEnd() { test::write_scan(folder_.path() / "scan.xyz", 1500, 2); }

  ProgramRun emax(const std::vector<std::string>& arguments) {
    return test::run_emax(arguments, folder_.path());
  }
  ProgramRun optimize(const std::string& output, std::vector<std::string> more = {},
                      const std::string& max_error = "3%", const std::string& budget = "10") {
    std::vector<std::string> arguments = {"optimize",    "scan.xyz", "--max-error", max_error,
                                          "-o",          output,     "--budget",    budget,
                                          "--decimator", "schroeder"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return emax(arguments);
  }
  json read(const std::string& name) { return json::parse(text(name)); }
  std::string text(const std::string& name) { return test::file_text(folder_.path() / name); }
  bool exists(const std::string& name) { return std::filesystem::exists(folder_.path() / name); }

  test::TemporaryFolder folder_;
};

TEST_F(EndToEnd, FindsACertifiedMeshWithinTheTolerance) {
  const ProgramRun run = optimize("mesh.ply", {"--json", "result.json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const json result = read("result.json"), certificate = read("mesh.ply.certificate.json");
  EXPECT_EQ(result.at("feasible"), true);
  EXPECT_LE(result.at("e_max").get<double>(), result.at("epsilon").get<double>());
  EXPECT_GT(result.at("e_max").get<double>(), 0);
  EXPECT_EQ(result.at("points"), 1500);
  EXPECT_EQ(result.at("evaluations"), 10);
  EXPECT_LT(result.at("triangles"), result.at("reconstruction_triangles"));
  for (const char* key : {"e_max", "epsilon", "e_max_squared_bits", "worst_point", "triangles",
                          "valid", "transform", "bound", "seed"}) {
    EXPECT_EQ(result.at(key), certificate.at(key)) << key;
  }
  for (const char* key : {"schema", "kernel_version", "excluded", "device", "device_counters"}) {
    EXPECT_TRUE(result.contains(key)) << key;
  }
  EXPECT_EQ(emax({"verify", "mesh.ply.certificate.json"}).exit_code, 0);
}

TEST_F(EndToEnd, SameSeedSameBytesForAnyJobsAndDevice) {
  ASSERT_EQ(optimize("one.ply", {"--jobs", "1"}).exit_code, 0);
  ASSERT_EQ(optimize("two.ply", {"--jobs", "2"}).exit_code, 0);
  ASSERT_EQ(optimize("sim.ply", {"--jobs", "2", "--device", "sim"}).exit_code, 0);
  ASSERT_EQ(optimize("other.ply", {"--seed", "7"}).exit_code, 0);
  const auto certificate = [this](const std::string& mesh) {
    json c = read(mesh + ".certificate.json");
    c.at("mesh").erase("file");  // the name we gave it
    return c.dump();
  };
  EXPECT_EQ(text("one.ply"), text("two.ply"));
  EXPECT_EQ(certificate("one.ply"), certificate("two.ply"));
  EXPECT_EQ(text("one.ply"), text("sim.ply"));
  EXPECT_EQ(certificate("one.ply"), certificate("sim.ply"));
  EXPECT_NE(certificate("one.ply"), certificate("other.ply"));
}

// Exactly planar, along the axes and tilted.
TEST_F(EndToEnd, APlanarCloudIsASurface) {
  for (const auto& [tilt, method] :
       {std::pair{0.0, "gp3"}, {0.0, "poisson"}, {0.25, "gp3"}, {0.25, "poisson"}}) {
    SCOPED_TRACE(fmt::format("{}, tilt {}", method, tilt));
    std::ofstream file(folder_ / "plane.xyz");
    for (int i = 0; i < 25; ++i) {
      for (int j = 0; j < 25; ++j) file << fmt::format("{} {} {}\n", i, j, tilt * i + 2 * tilt * j);
    }
    file.close();
    const ProgramRun run = emax({"optimize", "plane.xyz", "--max-error", "2%", "-o", "plane.ply",
                                 "--method", method, "--budget", "1", "--no-polish"});
    ASSERT_EQ(run.exit_code, 0) << run.output << run.errors;
    const json certificate = read("plane.ply.certificate.json");
    EXPECT_EQ(certificate.at("valid"), true);
    EXPECT_LT(certificate.at("triangles"), 300);
    EXPECT_EQ(emax({"verify", "plane.ply.certificate.json"}).exit_code, 0);
    EXPECT_EQ(emax({"error", "plane.xyz", "plane.ply", "--max-error", "2%"}).exit_code, 0);
  }
}

// The scan of a noisy cube.
TEST_F(EndToEnd, FollowsThePlanesOfTheScanWhereThatIsAskedFor) {
  const TriangleMesh cube = test::cube(16);
  {
    std::ofstream scan(folder_ / "cube.xyz");
    Random random(named_seed("scan of a cube", 1));
    for (const Point& v : cube.vertices) {
      const Point p = v + random.point(-0.008, 0.008);
      scan << fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
    }
  }
  const auto run = [&](const std::string& output, const std::string& features,
                       const std::string& jobs = "2") {
    const ProgramRun made =
        emax({"optimize", "cube.xyz", "--max-error", "2%", "-o", output, "--effort", "quick",
              "--features", features, "--jobs", jobs, "--json", output + ".json"});
    EXPECT_EQ(made.exit_code, 0) << made.errors;
    return read(output + ".json");
  };
  const json planes = run("planes.obj", "planes");
  EXPECT_GE(planes.at("regions").size(), 5u);
  EXPECT_EQ(planes.at("evaluations"), 1);
  EXPECT_NE(text("planes.obj").find("g plane_1\n"), std::string::npos);
  EXPECT_EQ(emax({"verify", "planes.obj.certificate.json"}).exit_code, 0);
  EXPECT_NE(text("planes.obj.certificate.json").find("features.band"), std::string::npos);
  const json all = run("all.obj", "all");  // a cube has no other shapes than its planes
  EXPECT_EQ(all.at("triangles"), planes.at("triangles"));
  EXPECT_EQ(text("all.obj"), text("planes.obj"));
  const json none = run("none.obj", "none");
  EXPECT_FALSE(none.contains("regions") && !none.at("regions").empty());
  const json decided = run("auto.obj", "auto");
  EXPECT_EQ(decided.at("evaluations"), 2);
  EXPECT_LE(decided.at("triangles").get<int>(),
            std::min(none.at("triangles").get<int>(), planes.at("triangles").get<int>()));
  run("auto1.obj", "auto", "1");
  EXPECT_EQ(text("auto1.obj"), text("auto.obj"));
}

// A scan that lacks what it stood on.
TEST_F(EndToEnd, ClosesTheSurfaceWhereThatIsAskedFor) {
  test::write_scan(folder_.path() / "whole.xyz", 4000, 2);
  std::ifstream whole(folder_ / "whole.xyz");
  std::ofstream open(folder_ / "open.xyz");
  double x = 0, y = 0, z = 0;
  while (whole >> x >> y >> z) {
    if (z > -0.8) open << fmt::format("{} {} {}\n", x, y, z);
  }
  open.close();
  const auto run = [&](const std::string& output, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"optimize", "open.xyz", "--max-error", "2%",
                                          "-o",       output,     "--effort",    "quick"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return emax(arguments);
  };
  const ProgramRun as_scanned = run("open.ply", {});
  ASSERT_EQ(as_scanned.exit_code, 0) << as_scanned.output << as_scanned.errors;
  EXPECT_EQ(read("open.ply.certificate.json").at("topology").at("border_loops"), 1);
  const ProgramRun closed = run("closed.ply", {"--closed"});
  ASSERT_EQ(closed.exit_code, 0) << closed.output << closed.errors;
  EXPECT_NE(closed.output.find("closed         1 hole of the surface"), std::string::npos);
  EXPECT_EQ(read("closed.ply.certificate.json").at("topology").at("border_loops"), 0);
  EXPECT_EQ(emax({"verify", "closed.ply.certificate.json"}).exit_code, 0);

  const ProgramRun other = run("other.ply", {"--closed", "--method", "gp3"});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.errors.find("--method fit"), std::string::npos) << other.errors;
}

TEST_F(EndToEnd, OptimizesOnTheHardware) {
  test::write_scan(folder_.path() / "scan.xyz", 400, 2);
  const test::BoardProgram board(EMAX_BOARD_PROGRAM);
  ASSERT_EQ(optimize("cpu.ply", {}, "20%", "1").exit_code, 0);
  const json expected = read("cpu.ply.certificate.json");
  for (const std::string& device : {std::string("rtl"), "tty:" + board.path()}) {
    SCOPED_TRACE(device);
    const ProgramRun run =
        optimize("mesh.ply", {"--device", device, "--json", "result.json"}, "20%", "1");
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_EQ(text("mesh.ply"), text("cpu.ply"));
    const json certificate = read("mesh.ply.certificate.json");
    for (const char* key : {"e_max", "e_max_squared_bits", "worst_point", "triangles"}) {
      EXPECT_EQ(certificate.at(key), expected.at(key)) << key;
    }
    EXPECT_GT(read("result.json").at("device_counters").at("busy"), 0);
    EXPECT_EQ(emax({"verify", "mesh.ply.certificate.json"}).exit_code, 0);
  }
}

TEST_F(EndToEnd, EveryDeviceAndBruteForceGiveTheSameBits) {
  test::write_surface(folder_.path() / "surface.off", 10, 14);
  std::vector<json> results;
  for (const std::vector<std::string>& how :
       std::vector<std::vector<std::string>>{{"--device", "cpu"},
                                             {"--device", "sim"},
                                             {"--device", "sim:board=zynq7020"},
                                             {"--device", "cpu", "--brute-force"},
                                             {"--device", "sim", "--brute-force"},
                                             {"--device", "rtl"},
                                             {"--device", "opencl"},
                                             {"--device", "sim:board=ulx3s"},
                                             {"--device", "rtl:board"}}) {
    std::vector<std::string> arguments = {"error", "scan.xyz", "surface.off", "--json", "r.json"};
    arguments.insert(arguments.end(), how.begin(), how.end());
    ASSERT_EQ(emax(arguments).exit_code, 0);
    results.push_back(read("r.json"));
  }
  for (const json& result : results) {
    for (const char* key : {"e_max_squared_bits", "worst_point", "e_max"}) {
      EXPECT_EQ(result.at(key), results[0].at(key)) << result.at("device");
    }
  }
  EXPECT_EQ(results[1].at("device_counters").at("pairs"),
            results[2].at("device_counters").at("pairs"));
  for (const char* key : {"blocks", "pairs", "words_in", "words_out"}) {
    for (const std::size_t device : {5, 6}) {
      EXPECT_EQ(results[device].at("device_counters").at(key),
                results[1].at("device_counters").at(key))
          << key;
    }
  }
  for (const char* key : {"cycles", "busy", "stalled", "idle"}) {
    EXPECT_TRUE(results[5].at("device_counters").at(key).is_number_unsigned()) << key;
  }
  EXPECT_TRUE(results[1].at("device_counters").at("resends").is_null());
  EXPECT_TRUE(results[1].at("predicted").is_null());
  const json& predicted = results[2].at("predicted");
  for (const char* key : {"seconds", "computing_seconds", "link_seconds", "cpu_seconds"}) {
    EXPECT_GT(predicted.at(key).get<double>(), 0) << key;
  }
  EXPECT_EQ(predicted.at("seconds"), std::max(predicted.at("computing_seconds").get<double>(),
                                              predicted.at("link_seconds").get<double>()));
  EXPECT_EQ(predicted.at("basis"), "estimated");
  EXPECT_EQ(predicted.at("cpu_basis"), "measured");
  EXPECT_TRUE(results[0].at("device_counters").is_null());  // the CPU counts nothing
  EXPECT_GT(results[4].at("device_counters").at("pairs"),
            results[1].at("device_counters").at("pairs"));
}

TEST_F(EndToEnd, ABoardsPredictionStandsBesideTheMeasuredCpu) {
  const ProgramRun run =
      optimize("board.ply", {"--device", "sim:board=u50", "--json", "r.json"}, "10%", "6");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  for (const char* text : {"% busy", " s on u50 (AMD Alveo U50), estimated: computing ",
                           "this CPU ", " s, measured: "}) {
    EXPECT_NE(run.output.find(text), std::string::npos) << text << "\n" << run.output;
  }
  EXPECT_GT(read("r.json").at("predicted").at("cpu_seconds").get<double>(), 0);
  // Without a board nothing is predicted, and what is not measured is not printed.
  const ProgramRun cpu = optimize("cpu.ply", {}, "3%", "6");
  for (const char* text : {"estimated", "measured", "cycles", "resends"}) {
    EXPECT_EQ(cpu.output.find(text), std::string::npos) << text << "\n" << cpu.output;
  }
}

TEST_F(EndToEnd, InfeasibleToleranceIsSaidAndNothingWritten) {
  const ProgramRun run = optimize("mesh.ply", {"--json", "result.json"}, "0.0001%");
  EXPECT_EQ(run.exit_code, 2) << run.errors;
  EXPECT_NE(run.output.find("infeasible"), std::string::npos) << run.output;
  EXPECT_EQ(read("result.json").at("feasible"), false);
  // Where every point is a vertex of a mesh that is not decimated, binary32 proves nothing.
  EXPECT_TRUE(run.output.find("below what the kernel can tell apart") != std::string::npos ||
              run.output.find("is the least found") != std::string::npos)
      << run.output;
  EXPECT_FALSE(exists("mesh.ply"));
  EXPECT_FALSE(exists("mesh.ply.certificate.json"));
}

TEST_F(EndToEnd, ErrorSaysWhetherAToleranceIsKept) {
  test::write_surface(folder_.path() / "surface.off", 10, 14);
  EXPECT_EQ(emax({"error", "scan.xyz", "surface.off", "--max-error", "50%"}).exit_code, 0);
  EXPECT_EQ(emax({"error", "scan.xyz", "surface.off", "--max-error", "0.001%"}).exit_code, 2);
}

TEST_F(EndToEnd, VerifyCatchesEveryFalseClaim) {
  ASSERT_EQ(optimize("mesh.ply").exit_code, 0);
  const std::string name = "mesh.ply.certificate.json";
  const json honest = read(name);
  const auto verdict = [&](const json& certificate) {
    std::ofstream(folder_.path() / "claim.json") << certificate;
    return emax({"verify", "claim.json"}).exit_code;
  };
  ASSERT_EQ(verdict(honest), 0);
  const auto altered = [&honest](auto change) {
    json claim = honest;
    change(claim);
    return claim;
  };
  const double e_max = honest.at("e_max");
  EXPECT_EQ(verdict(altered([&](json& c) { c["e_max"] = e_max / 2; })), 2);
  EXPECT_EQ(verdict(altered([&](json& c) { c["epsilon"] = e_max / 2; })), 2);
  EXPECT_EQ(verdict(altered([](json& c) { c["triangles"] = 4; })), 2);
  EXPECT_EQ(verdict(altered([](json& c) { c["points"] = 9; })), 2);
  EXPECT_EQ(verdict(altered([](json& c) { c["worst_point"] = 1499; })), 2);
  EXPECT_EQ(verdict(altered([](json& c) { c["e_max_squared_bits"] = "0x00000000"; })), 2);
  EXPECT_EQ(verdict(altered([](json& c) { c["validity"]["components"] = 77; })), 2);
  EXPECT_EQ(verdict(altered([](json& c) { c["topology"]["genus"] = 7; })), 2);
  EXPECT_EQ(verdict(altered([](json& c) { c["valid"] = !c["valid"].get<bool>(); })), 2);
  EXPECT_EQ(verdict(altered([&](json& c) { c["e_max_all"] = e_max / 2; })), 2);
  EXPECT_EQ(verdict(altered([](json& c) { c["transform"]["scale"] = 3; })), 2);
  EXPECT_EQ(verdict(altered([](json& c) { c["transform"]["origin"][1] = 3; })), 2);
  EXPECT_EQ(verdict(altered([](json& c) { c["mesh"]["sha256"] = "00"; })), 2);
  EXPECT_EQ(verdict(altered([](json& c) { c["cloud"]["sha256"] = "00"; })), 2);
  EXPECT_EQ(verdict(altered([](json& c) {
              c["excluded"] = json::array({{{"point", 123456}, {"distance", 1.0}}});
            })),
            2);
  EXPECT_EQ(verdict(altered([](json& c) { c.erase("epsilon"); })), 1);
  EXPECT_EQ(verdict(altered([](json& c) { c["excluded"] = nullptr; })), 1);
  for (const json& none : {json(0.5), json(-1), json(1e308), json(nullptr), json("1")}) {
    EXPECT_EQ(verdict(altered([&](json& c) { c["triangles"] = none; })), 1) << none;
    EXPECT_EQ(verdict(altered([&](json& c) { c["validity"]["components"] = none; })), 1) << none;
    EXPECT_EQ(verdict(altered([&](json& c) { c["worst_point"] = none; })), 1) << none;
  }
  EXPECT_EQ(verdict(altered([](json& c) { c["worst_point"] = std::uint64_t{1} << 32; })), 1);

  // The mesh itself: one bit of a coordinate.
  std::string bytes = text("mesh.ply");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  std::ofstream(folder_.path() / "mesh.ply", std::ios::binary) << bytes;
  EXPECT_EQ(emax({"verify", name}).exit_code, 2);
}

TEST_F(EndToEnd, OutliersAreNamed) {
  std::ofstream(folder_.path() / "scan.xyz", std::ios::app) << "3 0 0\n0 4 0\n";
  ASSERT_EQ(optimize("mesh.ply", {"--exclude-outliers", "0.5%", "--json", "r.json"}).exit_code, 0);
  const json certificate = read("mesh.ply.certificate.json");
  const json& excluded = certificate.at("excluded");
  ASSERT_GE(excluded.size(), 2u);
  ASSERT_LE(excluded.size(), 7u);
  std::vector<int> points;
  for (const json& point : excluded) {
    points.push_back(point.at("point").get<int>());
    EXPECT_GT(point.at("distance").get<double>(), certificate.at("epsilon").get<double>());
  }
  EXPECT_NE(std::ranges::find(points, 1500), points.end());
  EXPECT_NE(std::ranges::find(points, 1501), points.end());
  EXPECT_GT(certificate.at("e_max_all").get<double>(), 2);
  EXPECT_EQ(certificate.at("points").get<std::size_t>() + excluded.size(), 1502u);
  const ProgramRun verified = emax({"verify", "mesh.ply.certificate.json"});
  EXPECT_EQ(verified.exit_code, 0);
  EXPECT_NE(verified.output.find(
                fmt::format(" {} of its 1,502 points are excluded, the farthest", excluded.size())),
            std::string::npos)
      << verified.output;
  for (const auto& change : std::vector<std::function<void(json&)>>{
           [](json& c) { c["excluded"][0]["distance"] = 0; },
           [](json& c) { c["excluded"].push_back(c["excluded"][0]); },
           [](json& c) { c["e_max_all"] = c["e_max"]; }}) {
    json claim = certificate;
    change(claim);
    std::ofstream(folder_.path() / "claim.json") << claim;
    const ProgramRun run = emax({"verify", "claim.json"});
    EXPECT_EQ(run.exit_code, 2) << run.errors;
    EXPECT_TRUE(run.output.starts_with("no: ")) << run.output;
  }
}

TEST_F(EndToEnd, SkippedPointsKeepTheFilesIndices) {
  const std::string scan = text("scan.xyz");
  std::ofstream(folder_.path() / "scan.xyz") << "nan 0 0\n0 inf 0\n" << scan;
  EXPECT_EQ(optimize("mesh.ply").exit_code, 1);
  ASSERT_EQ(optimize("mesh.ply", {"--skip-invalid"}).exit_code, 0);
  const json skipped = read("mesh.ply.certificate.json");
  EXPECT_EQ(emax({"verify", "mesh.ply.certificate.json"}).exit_code, 0);
  std::ofstream(folder_.path() / "scan.xyz") << scan;
  ASSERT_EQ(optimize("mesh.ply").exit_code, 0);
  const json plain = read("mesh.ply.certificate.json");
  EXPECT_EQ(skipped.at("worst_point").get<int>(), plain.at("worst_point").get<int>() + 2);
  EXPECT_EQ(skipped.at("e_max"), plain.at("e_max"));
}

// Millimetre detail ten thousand kilometres from the origin: nothing of it is lost.
TEST_F(EndToEnd, FarFromTheOriginIsAsGoodAsNear) {
  ASSERT_EQ(optimize("near.ply").exit_code, 0);
  std::ifstream scan(folder_.path() / "scan.xyz");
  std::ofstream far(folder_.path() / "far.xyz");
  for (double x, y, z; scan >> x >> y >> z;) {
    far << fmt::format("{:.9f} {:.9f} {:.9f}\n", 1e7 + x, -2e7 + y, 5e6 + z);
  }
  far.close();
  std::filesystem::rename(folder_.path() / "far.xyz", folder_.path() / "scan.xyz");
  ASSERT_EQ(optimize("far.ply").exit_code, 0);
  const json near_by = read("near.ply.certificate.json"),
             far_off = read("far.ply.certificate.json");
  EXPECT_NEAR(far_off.at("triangles").get<double>() / near_by.at("triangles").get<double>(), 1,
              0.1);
  EXPECT_NEAR(far_off.at("epsilon").get<double>(), near_by.at("epsilon").get<double>(), 1e-8);
  EXPECT_EQ(emax({"verify", "far.ply.certificate.json"}).exit_code, 0);
}

TEST_F(EndToEnd, DuplicatedPointsAreFine) {
  const std::string scan = text("scan.xyz");
  std::ofstream(folder_.path() / "scan.xyz", std::ios::app) << scan;
  ASSERT_EQ(optimize("mesh.ply").exit_code, 0);
  const json certificate = read("mesh.ply.certificate.json");
  EXPECT_EQ(certificate.at("points"), 3000);
  EXPECT_LT(certificate.at("worst_point"), 1500) << "the lowest index of equals";
}

TEST_F(EndToEnd, InterruptedRunEndsCleanly) {
  const ProgramRun run =
      test::run_emax({"optimize", "scan.xyz", "--max-error", "3%", "-o", "mesh.ply", "--budget",
                      "100000", "--decimator", "schroeder"},
                     folder_.path(), 6);
  EXPECT_EQ(run.exit_code, 130) << run.errors;
  // Either the best so far, whole and true, or nothing; what was evaluated is kept.
  const std::size_t kept = exists("mesh.ply.run") ? 1 : 0;
  if (exists("mesh.ply")) {
    EXPECT_EQ(emax({"verify", "mesh.ply.certificate.json"}).exit_code, 0);
    EXPECT_EQ(test::files_in(folder_.path()).size(), 3 + kept);
  } else {
    EXPECT_EQ(test::files_in(folder_.path()).size(), 1 + kept);
  }
}

TEST_F(EndToEnd, TimeLimitWritesTheBestSoFar) {
  const ProgramRun run =
      test::run_emax({"optimize", "scan.xyz", "--max-error", "3%", "-o", "mesh.ply", "--budget",
                      "100000", "--time", "8", "--decimator", "schroeder"},
                     folder_.path());
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_NE(run.output.find("out of time"), std::string::npos) << run.output;
  EXPECT_EQ(emax({"verify", "mesh.ply.certificate.json"}).exit_code, 0);
}

// All of it: reading, the reference, the search, the deep decimation and the certificate.
TEST_F(EndToEnd, TimeIsKept) {
  const auto timed = [this](const std::vector<std::string>& limit) {
    std::vector<std::string> arguments = {"optimize", "scan.xyz", "--max-error",
                                          "1%",       "-o",       "mesh.ply"};
    arguments.insert(arguments.end(), limit.begin(), limit.end());
    const auto start = std::chrono::steady_clock::now();
    const ProgramRun run = emax(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  // Enough for the reference surface and a few evaluations, in a slow build too.
  const double limit = std::max(6.0, std::ceil(2 * timed({"--effort", "quick"})));
  EXPECT_LT(timed({"--budget", "100000", "--time", std::to_string(limit)}), limit * 4 / 3);
  EXPECT_EQ(emax({"verify", "mesh.ply.certificate.json"}).exit_code, 0);

  const ProgramRun hasty =
      emax({"optimize", "scan.xyz", "--max-error", "3%", "-o", "none.ply", "--time", "0.001"});
  EXPECT_EQ(hasty.exit_code, 1);
  EXPECT_NE(hasty.errors.find("--time ended while the reference surface was made"),
            std::string::npos)
      << hasty.errors;
  EXPECT_FALSE(exists("none.ply"));
}

TEST_F(EndToEnd, AllMethodsAndMeshFormats) {
  for (const char* method : {"gp3", "poisson", "hoppe"}) {
    SCOPED_TRACE(method);
    ASSERT_EQ(optimize("mesh.obj", {"--method", method}, "8%", "2").exit_code, 0);
    EXPECT_EQ(emax({"verify", "mesh.obj.certificate.json"}).exit_code, 0);
  }
  for (const char* name : {"mesh.off", "mesh.stl", "mesh.ply"}) {
    SCOPED_TRACE(name);
    ASSERT_EQ(optimize(name, {}, "8%", "1").exit_code, 0);
    EXPECT_EQ(emax({"verify", std::string(name) + ".certificate.json"}).exit_code, 0);
  }
}

// Every method is a gene: its candidates may lie in any worker's cache, or in none.
TEST_F(EndToEnd, AutoGivesTheSameBytesForAnyJobs) {
  test::write_scan(folder_.path() / "scan.xyz", 400, 2);
  std::vector<std::string> arguments = {"optimize", "scan.xyz", "--max-error", "8%",
                                        "-o",       "mesh.ply", "--budget",    "4",
                                        "--method", "auto",     "--jobs",      "1"};
  const ProgramRun run = emax(arguments);
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const json c = read("mesh.ply.certificate.json");
  EXPECT_EQ(c.at("valid"), true);
  EXPECT_NE(c.at("method"), "auto");
  EXPECT_EQ(c.at("parameters").contains("gp3.mu"), c.at("method") == "gp3");
  EXPECT_EQ(emax({"verify", "mesh.ply.certificate.json"}).exit_code, 0);
  const std::string mesh = text("mesh.ply"), certificate = text("mesh.ply.certificate.json");
  arguments.back() = "2";
  ASSERT_EQ(emax(arguments).exit_code, 0);
  EXPECT_EQ(text("mesh.ply"), mesh);
  EXPECT_EQ(text("mesh.ply.certificate.json"), certificate);
}

TEST_F(EndToEnd, TheBoundedDecimatorKeepsBothBounds) {
  test::write_scan(folder_.path() / "scan.xyz", 600, 2);
  std::vector<std::string> arguments = {"optimize", "scan.xyz", "--max-error", "3%",
                                        "-o",       "mesh.ply", "--budget",    "4",
                                        "--json",   "r.json",   "--jobs",      "2"};
  const ProgramRun run = emax(arguments);
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const json c = read("mesh.ply.certificate.json"), result = read("r.json");
  EXPECT_EQ(c.at("bound"), "two-sided");
  EXPECT_EQ(c.at("decimator"), "bounded");
  EXPECT_EQ(c.at("valid"), true);
  EXPECT_EQ(c.at("reference"), result.at("reference"));
  EXPECT_LE(c.at("reference").at("mesh_to_reference"), c.at("epsilon"));
  EXPECT_GT(c.at("reference").at("reference_to_mesh"), 0);
  EXPECT_EQ(c.at("topology"), result.at("topology"));
  EXPECT_EQ(c.at("topology").at("components"), 1);
  EXPECT_GT(c.at("reference").at("triangles"), 5 * c.at("triangles").get<int>());
  EXPECT_TRUE(exists("mesh.ply.reference.ply"));
  EXPECT_EQ(emax({"verify", "mesh.ply.certificate.json"}).exit_code, 0);
  // One job, and the same bytes.
  const std::string mesh = text("mesh.ply"), certificate = text("mesh.ply.certificate.json");
  arguments.back() = "1";
  ASSERT_EQ(emax(arguments).exit_code, 0);
  EXPECT_EQ(text("mesh.ply"), mesh);
  EXPECT_EQ(text("mesh.ply.certificate.json"), certificate);

  // The reference is recomputed from its file, and has to be that file.
  EXPECT_EQ(emax({"verify", "mesh.ply.certificate.json", "--reference", "mesh.ply"}).exit_code, 2);

  arguments.insert(arguments.end(), {"--bound", "one-sided"});
  ASSERT_EQ(emax(arguments).exit_code, 0);
  const json one = read("mesh.ply.certificate.json");
  EXPECT_EQ(one.at("bound"), "one-sided");
  EXPECT_LE(one.at("triangles"), c.at("triangles"));
  EXPECT_EQ(emax({"verify", "mesh.ply.certificate.json"}).exit_code, 0);
}

// A handful of points far from the surface: named, left out by the decimator too, and the bound
// holds for the rest in both directions.
TEST_F(EndToEnd, TheBoundedDecimatorLeavesOutliersOut) {
  std::ofstream scan(folder_.path() / "scan.xyz", std::ios::app);
  // Too far from each other for a reconstruction to join them.
  for (const double x : {-0.9, 0.0, 0.9}) {
    for (const double y : {-0.9, 0.0}) scan << x << ' ' << y << " 1.6\n";
  }
  scan << "-0.9 0.9 1.6\n";
  scan.close();
  const std::vector<std::string> arguments = {"optimize", "scan.xyz", "--max-error", "3%",
                                              "-o",       "mesh.ply", "--budget",    "4"};
  std::vector<std::string> excluding = arguments;
  excluding.insert(excluding.end(), {"--exclude-outliers", "0.5%"});
  const ProgramRun run = emax(excluding);
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_NE(run.output.find("outliers       7 points"), std::string::npos) << run.output;
  const json c = read("mesh.ply.certificate.json");
  EXPECT_EQ(c.at("valid"), true);
  EXPECT_EQ(c.at("excluded").size(), 7u);
  EXPECT_LE(c.at("reference").at("points_to_reference"), c.at("epsilon"));
  EXPECT_EQ(emax({"verify", "mesh.ply.certificate.json"}).exit_code, 0);
}

}  // namespace
}  // namespace emax
