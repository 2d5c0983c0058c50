#include "host/decimate/chain.h"

#include <gtest/gtest.h>

#include <set>

#include "host/geometry/mesh_validity.h"
#include "host/reconstruct/reconstruction_parameters.h"
#include "sw_model/error.h"
#include "tests/host/reconstruct/surface_clouds.h"

namespace emax::test {
namespace {

ChainSettings settings(const std::string& method) {
  ChainSettings result{method, "schroeder", standard_values(chain_parameters(method, "schroeder"))};
  if (method == "hoppe") result.parameters["hoppe.resolution"] = 32;
  return result;
}

TEST(ChainParameters, JoinTheStagesWithStandardsInTheirDomains) {
  for (const std::string_view method : reconstruction_methods()) {
    for (const std::string_view decimator : decimators()) {
      const auto chain = chain_parameters(method, decimator);
      std::set<std::string> names;
      for (const ParameterSpec& spec : chain) {
        EXPECT_TRUE(names.insert(spec.name).second) << spec.name;
        EXPECT_LT(spec.lower, spec.upper) << spec.name;
        EXPECT_LE(spec.lower, spec.standard) << spec.name;
        EXPECT_LE(spec.standard, spec.upper) << spec.name;
        EXPECT_FALSE(spec.meaning.empty()) << spec.name;
      }
      EXPECT_EQ(chain.size(), reconstruction_parameters(method).size() + 1 +
                                  decimation_parameters(decimator).size());
      EXPECT_TRUE(names.contains("fill.size"));
    }
  }
  EXPECT_THROW(chain_parameters("gp3", "quadric"), Error);
  EXPECT_THROW(chain_parameters("alpha", "schroeder"), Error);
}

TEST(RunChain, MakesASmallerMesh) {
  const std::vector<Point> cloud = torus_cloud(60, 24);
  for (const std::string method : {"gp3", "hoppe"}) {
    StageCache cache;
    const ChainResult result = run_chain(cloud, settings(method), cache);
    EXPECT_LT(result.mesh.triangles.size(), result.reconstruction_triangles / 2) << method;
    EXPECT_GT(result.mesh.triangles.size(), 100u) << method;
    EXPECT_EQ(check_mesh(result.mesh.view()).inconsistent_edges, 0u) << method;
  }
}

// The twin of the cache is no cache.
TEST(RunChain, TakesNoNoticeOfTheCache) {
  const std::vector<Point> cloud = torus_cloud(40, 16);
  StageCache shared(2);
  Random random(9);
  SCOPED_TRACE("seed 9");
  for (int i = 0; i < 12; ++i) {
    ChainSettings candidate = settings("gp3");
    candidate.parameters["gp3.mu"] = 2 + 0.5 * random.below(4);
    candidate.parameters["schroeder.reduction"] = random.uniform(0.2, 0.9);
    StageCache fresh;
    const ChainResult expected = run_chain(cloud, candidate, fresh);
    const ChainResult result = run_chain(cloud, candidate, shared);
    EXPECT_TRUE(same_bytes(result.mesh, expected.mesh)) << i;
    EXPECT_EQ(result.reconstruction_triangles, expected.reconstruction_triangles);
    EXPECT_EQ(result.unmeshed_points, expected.unmeshed_points);
  }
}

TEST(StageCache, KeepsAReconstructionForOtherDecimationAndGivesUpTheOldest) {
  const std::vector<Point> cloud = torus_cloud(20, 12);
  StageCache cache(2);
  ChainSettings a = settings("gp3"), b = a, c = a;
  b.parameters["gp3.mu"] = 3;
  c.parameters["gp3.mu"] = 4;
  const auto address = [&](const ChainSettings& s) {
    return cache.reconstruct(cloud, s).mesh.vertices.data();
  };
  const Point* first = address(a);
  a.parameters["schroeder.reduction"] = 0.1;
  EXPECT_EQ(address(a), first);
  const Point* second = address(b);
  EXPECT_EQ(address(a), first);
  address(c);  // b, unused for longest, goes
  EXPECT_EQ(address(a), first);
  EXPECT_EQ(cache.size(), 2u);
  EXPECT_NE(second, first);
}

TEST(RunChain, NamesAMissingParameter) {
  for (const ParameterSpec& spec : chain_parameters("gp3", "schroeder")) {
    ChainSettings lacking = settings("gp3");
    lacking.parameters.erase(spec.name);
    StageCache cache;
    try {
      run_chain(torus_cloud(20, 12), lacking, cache);
      ADD_FAILURE() << "no error without " << spec.name;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(spec.name), std::string::npos) << e.what();
    }
  }
}

}  // namespace
}  // namespace emax::test
