// Meshes that are measured in parts, beside the same meshes in memory.
#include "host/app/measured_mesh.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "host/app/error_findings.h"
#include "host/app/point_claims.h"
#include "host/files/sha256.h"
#include "host/geometry/bounds.h"
#include "host/geometry/merge_vertices.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/certify/surface_distance.h"
#include "tests/host/app/program.h"
#include "tests/support/las_of_points.h"
#include "tests/support/messages.h"
#include "tests/support/pipe_writer.h"
#include "tests/support/stimuli.h"
#include "tests/support/temporary_folder.h"

namespace emax {
namespace {

constexpr std::uint64_t kEnough = std::uint64_t{1} << 30;  // bytes

Scan scan_of(const std::vector<Point>& points) {
  Scan scan;
  scan.path = "scan";
  scan.cloud.points = points;
  scan.width = bounds_of(points).width();
  return scan;
}

MeasuredMesh whole_mesh(const std::filesystem::path& file) {
  TriangleMesh mesh = read_mesh(file);
  drop_unused_vertices(mesh.vertices, mesh.triangles);
  return MeasuredMesh(std::move(mesh));
}

// All that is found, as text of which every bit counts.
std::string found(const MeasuredMesh& mesh, const ScanPieces& scan, const ErrorQuestion& question) {
  const ErrorFindings f = find_errors(mesh, scan, std::nullopt, question);
  std::string text = to_json_text(report_of(f, scan.scan()));
  for (const double d : f.distances) text += fmt::format("{:a} ", d);
  for (const std::uint32_t i : f.measured.excluded) text += fmt::format("{} ", i);
  text += fmt::format("{} {} {:a}", f.measured.all.squared_bits, f.measured.all.worst_point,
                      f.measured.violation);
  return text;
}

std::vector<ErrorQuestion> questions() {
  ErrorQuestion plain, all, every_pair;
  plain.memory = all.memory = every_pair.memory = kEnough;
  all.tolerance = parse_tolerance("3%", "--max-error");
  all.excluded_share = 0.07;
  all.worst = 40;
  every_pair.brute_force = true;
  every_pair.worst = 0;
  every_pair.memory = 0;  // the distances are in a file
  return {plain, all, every_pair};
}

// For every kind of mesh and cloud, and parts of several sizes.
void expect_same(const test::Stimulus& s) {
  SCOPED_TRACE(s.name);
  const test::TemporaryFolder folder;
  write_mesh(folder / "mesh.ply", {s.vertices, s.triangles});
  const MeasuredMesh whole = whole_mesh(folder / "mesh.ply");
  const Scan scan = scan_of(s.cloud);
  const ScanPieces pieces(scan);
  for (const ErrorQuestion& question : questions()) {
    const std::string expected = found(whole, pieces, question);
    for (const std::size_t size : {std::size_t{1}, std::size_t{13}, std::size_t{150}}) {
      if (s.triangles.size() > 40 * size) continue;  // the greater sizes are enough there
      const MeasuredMesh parts(folder / "mesh.ply", kEnough, size);
      EXPECT_TRUE(found(parts, pieces, question) == expected) << "parts of " << size;
    }
  }
}

TEST(MeasuredMesh, InPartsGivesTheBitsOfTheWhole) {
  for (const test::Stimulus& s : test::all_stimuli(301)) {
    if (bounds_of(s.cloud).width() > 0) expect_same(s);
  }
}

// The certificate and the kernel's worst point, as `emax verify` recomputes them.
TEST(MeasuredMesh, InPartsGivesTheClaimsOfTheWhole) {
  const test::TemporaryFolder folder;
  const test::Stimulus s = test::bumpy_sphere(20, 30, 3000, 302);
  write_mesh(folder / "mesh.stl", {s.vertices, s.triangles});
  const Scan scan = scan_of(s.cloud);
  const ScanPieces pieces(scan);
  LocalPieces here;
  const std::vector<std::uint32_t> excluded = {2, 77, 2999};
  const auto claims = [&](const MeasuredMesh& mesh) {
    return recompute(pieces, mesh, nullptr, excluded, here, {}, 0);
  };
  const PointClaims whole = claims(whole_mesh(folder / "mesh.stl"));
  for (const std::size_t size : {30u, 400u, 5000u}) {
    const PointClaims parts = claims(MeasuredMesh(folder / "mesh.stl", kEnough, size));
    EXPECT_EQ(parts.kernel, whole.kernel);
    EXPECT_EQ(parts.error.e_max_upper, whole.error.e_max_upper);
    EXPECT_EQ(parts.error.worst_point, whole.error.worst_point);
    EXPECT_EQ(parts.error.points, whole.error.points);
    EXPECT_EQ(parts.error.excluded, whole.error.excluded);
    EXPECT_EQ(parts.error.excluded_distances, whole.error.excluded_distances);
    EXPECT_LE(parts.error.e_max_lower, parts.error.e_max_upper);
    EXPECT_NEAR(parts.error.e_max_lower, whole.error.e_max_lower, 1e-13);
  }
}

// Of a cloud that is read in pieces, and of one with points that are left out.
TEST(MeasuredMesh, AndACloudInPiecesGiveTheBitsOfTheWhole) {
  const test::TemporaryFolder folder;
  const test::Stimulus s = test::bumpy_sphere(16, 24, 40000, 303);
  write_mesh(folder / "mesh.ply", {s.vertices, s.triangles});
  {
    std::ofstream file(folder / "scan.xyz");
    for (const Point& p : s.cloud) file << fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
    file << "nan 0 0\n3 0 0\n";
  }
  const CloudReadOptions reading = {.skip_invalid = true};
  const ScanPieces held(folder / "scan.xyz", reading, "", kEnough, nullptr);
  const ScanPieces read(folder / "scan.xyz", reading, "", 0, nullptr);
  ASSERT_FALSE(read.is_in_memory());
  ErrorQuestion question;
  question.tolerance = parse_tolerance("3%", "--max-error");
  question.excluded_share = 1e-4;
  question.memory = 0;
  const std::string expected = found(whole_mesh(folder / "mesh.ply"), read, question);
  const MeasuredMesh parts(folder / "mesh.ply", kEnough, 100);
  EXPECT_TRUE(found(parts, read, question) == expected);
  EXPECT_EQ(nlohmann::json::parse(to_json_text(
                report_of(find_errors(parts, held, std::nullopt, question), held.scan()))),
            nlohmann::json::parse(to_json_text(report_of(
                find_errors(whole_mesh(folder / "mesh.ply"), held, std::nullopt, question),
                held.scan()))));
}

TEST(MeasuredMesh, NoticesThatTheFileChanges) {
  const test::TemporaryFolder folder;
  const test::Stimulus s = test::bumpy_sphere(6, 8, 100, 304);
  write_mesh(folder / "mesh.ply", {s.vertices, s.triangles});
  const Scan scan = scan_of(s.cloud);
  const ScanPieces pieces(scan);
  const MeasuredMesh mesh(folder / "mesh.ply", kEnough, 20);
  const PartwiseDistances distances(pieces, mesh, {});
  const double upper = distances.of(std::uint64_t{5}).upper;
  EXPECT_LE(distances.lower_end(s.cloud[5], upper), upper);
  std::fstream file(folder / "mesh.ply", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(-static_cast<std::streamoff>(13 * s.triangles.size() + 8), std::ios::end);
  file.write("\0\0\0\0\0\0\x59\x40", 8);  // 100, z of the last vertex
  file.close();
  test::expect_clear(test::message_of([&] { distances.lower_end(s.cloud[5], upper); }),
                     (folder / "mesh.ply").string(), "was changed while it was read", "leave it");
}

TEST(MeasuredMeshFault, APartThatIsForgottenIsNoticed) {
  const test::TemporaryFolder folder;
  const test::Stimulus s = test::bumpy_sphere(6, 8, 300, 305);
  write_mesh(folder / "mesh.ply", {s.vertices, s.triangles});
  const Scan scan = scan_of(s.cloud);
  const ScanPieces pieces(scan);
  const DeliberateFault fault(Fault::kForgetsParts);
  const MeasuredMesh parts(folder / "mesh.ply", kEnough, 20);
  const ErrorQuestion question = questions().front();
  EXPECT_FALSE(found(parts, pieces, question) ==
               found(whole_mesh(folder / "mesh.ply"), pieces, question));
}

// A mesh of 404,100 triangles, and the program.
class MeasuredMeshProgram : public testing::Test {
 protected:
  MeasuredMeshProgram() {
    const test::Stimulus s = test::bumpy_sphere(450, 450, 0, 306);
    triangles_ = s.triangles.size();
    write_mesh(folder_ / "mesh.ply", {s.vertices, s.triangles});
    write_mesh(folder_ / "mesh.off", {s.vertices, s.triangles});
    test::write_scan(folder_ / "scan.xyz", 20000, 2);
  }
  test::ProgramRun error(const std::string& mesh, std::vector<std::string> more) {
    more.insert(more.begin(), {"error", "scan.xyz", mesh, "--json", "r.json"});
    return test::run_emax(more, folder_.path());
  }
  Certificate certificate_of(const ErrorFindings& f, const char* file, const TriangleMesh& mesh) {
    Certificate certificate;
    certificate.mesh_file = file;
    certificate.mesh_sha256 = sha256_of_input(folder_ / file);
    certificate.cloud_file = "scan.xyz";
    certificate.cloud_sha256 = sha256_of_input(folder_ / "scan.xyz");
    certificate.epsilon = f.certified.e_max_upper;
    certificate.error = f.certified;
    certificate.kernel = f.measured.kept;
    certificate.triangles = mesh.triangles.size();
    certificate.vertices = mesh.vertices.size();
    certificate.validity = f.validity;
    certificate.topology = f.topology;
    certificate.transform = f.transform;
    return certificate;
  }
  nlohmann::json result() { return nlohmann::json::parse(test::file_text(folder_ / "r.json")); }

  test::TemporaryFolder folder_;
  std::size_t triangles_;
};

TEST_F(MeasuredMeshProgram, KeepsToTheMemory) {
  const test::ProgramRun parts = error("mesh.ply", {"--memory", "100MB"});
  ASSERT_EQ(parts.exit_code, 0) << parts.errors;
  EXPECT_NE(parts.output.find(", in parts; valid"), std::string::npos) << parts.output;
  const nlohmann::json in_parts = result();
  const test::ProgramRun whole = error("mesh.ply", {});
  ASSERT_EQ(whole.exit_code, 0) << whole.errors;
  EXPECT_EQ(in_parts, result());
  EXPECT_EQ(in_parts.at("triangles"), triangles_);
#ifndef __SANITIZE_ADDRESS__
  EXPECT_LT(parts.resident_bytes, 100'000'000u);
#endif
  EXPECT_GT(whole.resident_bytes, 100'000'000u);
}

TEST_F(MeasuredMeshProgram, VerifiesWithinTheMemory) {
  const Scan scan = read_scan(folder_ / "scan.xyz", {});
  // In parts: what a child process takes is counted from what this one does.
  const ErrorFindings f = find_errors(MeasuredMesh(folder_ / "mesh.ply", 100'000'000),
                                      ScanPieces(scan), std::nullopt, {});
  Certificate certificate = certificate_of(f, "mesh.ply", read_mesh(folder_ / "mesh.ply"));
  const auto verify = [&](const std::string& memory) {
    std::ofstream(folder_ / "c.json") << to_json_text(certificate);
    return test::run_emax({"verify", "c.json", "--memory", memory}, folder_.path());
  };
  const test::ProgramRun whole = verify("1GB"), parts = verify("100MB");
  EXPECT_EQ(whole.exit_code, 0) << whole.output << whole.errors;
  EXPECT_EQ(parts.exit_code, 0) << parts.output << parts.errors;
  EXPECT_EQ(parts.output, whole.output);
#ifndef __SANITIZE_ADDRESS__
  EXPECT_LT(parts.resident_bytes, 100'000'000u);
#endif
  EXPECT_GT(whole.resident_bytes, 100'000'000u);
  const auto expect_refuted = [&](const char* why) {
    const test::ProgramRun refuted = verify("100MB");
    EXPECT_EQ(refuted.exit_code, 2) << refuted.errors;
    EXPECT_NE(refuted.output.find(why), std::string::npos) << refuted.output;
    EXPECT_EQ(refuted.output, verify("1GB").output);
  };
  const Certificate right = certificate;
  certificate.error.e_max_upper *= 0.9;
  expect_refuted("the certificate claims e_max");
  certificate = right;
  ++certificate.vertices;
  expect_refuted("the mesh has");
  certificate = right;
  ++certificate.validity.boundary_edges;
  expect_refuted("the mesh's validity differs");
  certificate = right;
  ++certificate.topology.genus;
  expect_refuted("the certificate claims 1 component");
}

TEST_F(MeasuredMeshProgram, NamesWhatNeedsTheWholeMesh) {
  const std::vector<std::vector<std::string>> needy = {{"--two-sided"},
                                                       {"--deviations", "d.ply"},
                                                       {"--report", "r.html"},
                                                       {"--picture", "p.png"},
                                                       {"--device", "sim"}};
  for (std::vector<std::string> more : needy) {
    const std::string option = more.front();
    more.insert(more.end(), {"--memory", "100MB"});
    const test::ProgramRun run = error("mesh.ply", more);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_NE(run.errors.find(option + " needs all of them at once; give --memory 198MB"),
              std::string::npos)
        << run.errors;
  }
  const test::ProgramRun few = error("mesh.ply", {"--memory", "1MB"});
  EXPECT_EQ(few.exit_code, 1);
  EXPECT_NE(few.errors.find("more than the 1 MB of --memory; give more memory"), std::string::npos)
      << few.errors;
  EXPECT_EQ(std::ranges::count(few.errors, '\n'), 1) << few.errors;
  const test::ProgramRun other = error("mesh.off", {"--memory", "100MB"});
  EXPECT_EQ(other.exit_code, 0) << other.errors;
  EXPECT_NE(other.output.find("mesh.off is held whole, about"), std::string::npos) << other.output;
}

// Points that come through a pipe are needed for every part: they are kept where they fit, or
// copied from standard input.
TEST_F(MeasuredMeshProgram, TakesPointsFromAPipe) {
  const auto rest = [](const test::ProgramRun& run) {
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    return run.output.substr(run.output.find("cloud to mesh"));
  };
  for (const std::size_t points : {20000u, 450000u}) {
    const std::string las = test::las_of_points(test::bumpy_sphere(4, 4, points, 2).cloud);
    folder_.write("scan.las", las);
    const auto of = [&](const std::string& cloud) {
      return test::run_emax({"error", cloud, "mesh.ply", "--memory", "100MB"}, folder_.path());
    };
    const std::string stored = rest(of("scan.las"));
    {
      const test::PipeWriter writer(folder_ / "pipe", las);
      const test::InputFrom input(folder_ / "pipe");
      EXPECT_EQ(rest(of("-")), stored);
    }
    const test::PipeWriter writer(folder_ / "pipe", las);
    const test::ProgramRun piped = of("pipe");
    if (points == 20000) {
      EXPECT_EQ(rest(piped), stored);
    } else {
      EXPECT_EQ(piped.exit_code, 1);
      EXPECT_NE(piped.errors.find("a mesh in parts needs to see it twice; store the scan"),
                std::string::npos)
          << piped.errors;
    }
  }
}

// The fine mesh as the reference of a coarse one.
TEST_F(MeasuredMeshProgram, VerifiesAgainstAReferenceInParts) {
  const test::Stimulus s = test::bumpy_sphere(60, 60, 0, 306);
  const TriangleMesh coarse{s.vertices, s.triangles};
  write_mesh(folder_ / "coarse.ply", coarse);
  const TriangleMesh fine = read_mesh(folder_ / "mesh.ply");
  const Scan scan = read_scan(folder_ / "scan.xyz", {});
  const ScanPieces pieces(scan);
  ErrorFindings f = find_errors(MeasuredMesh(coarse), pieces, std::nullopt, {});
  Certificate certificate = certificate_of(f, "coarse.ply", coarse);
  ReferenceBound& bound = certificate.reference.emplace();
  bound.file = "mesh.ply";
  bound.sha256 = sha256_of_input(folder_ / "mesh.ply");
  bound.triangles = triangles_;
  bound.topology = topology_of(fine.view());
  const SurfaceDistanceOptions precise = {.relative = 1e-9};
  bound.mesh_to_reference = bound.epsilon_back =
      (1 + 1e-6) * surface_distance(coarse.view(), ExactMesh(fine.view()), precise).upper;
  bound.reference_to_mesh =
      (1 + 1e-6) * surface_distance(fine.view(), ExactMesh(coarse.view()), precise).upper;
  certificate.epsilon = std::max(certificate.epsilon, bound.reference_to_mesh);
  LocalPieces here;
  bound.points_to_reference =
      recompute(pieces, MeasuredMesh(fine), nullptr, {}, here, {}, 0).error.e_max_upper;
  const auto verify = [&](const std::string& memory) {
    std::ofstream(folder_ / "c.json") << to_json_text(certificate);
    return test::run_emax({"verify", "c.json", "--memory", memory}, folder_.path());
  };
  const auto expect_answer = [&](int exit_code, const std::string& what) {
    const test::ProgramRun parts = verify("100MB"), whole = verify("1GB");
    EXPECT_EQ(parts.exit_code, exit_code) << parts.output << parts.errors;
    EXPECT_EQ(whole.exit_code, exit_code) << whole.output << whole.errors;
    for (const std::string& output : {parts.output, whole.output}) {
      EXPECT_NE(output.find(what), std::string::npos) << output;
    }
  };
  expect_answer(0, "yes: all of mesh.ply lies within");
  const Certificate right = certificate;
  bound.mesh_to_reference *= 1 - 1e-5;
  expect_answer(2, "for the distance of the mesh to the reference, which lies within");
  certificate = right;
  certificate.reference->reference_to_mesh *= 1 - 1e-5;
  expect_answer(2, "for the distance of the reference to the mesh, which lies within");
  certificate = right;
  certificate.reference->points_to_reference *= 1 - 1e-5;
  expect_answer(2, "for the distance of the points to the reference, which is");
  certificate = right;
  ++certificate.reference->topology.border_loops;
  expect_answer(2, "for the reference, which has");
}

}  // namespace
}  // namespace emax
