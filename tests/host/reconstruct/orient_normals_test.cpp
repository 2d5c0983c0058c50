#include "host/reconstruct/orient_normals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/host/support/surface_clouds.h"

namespace emax::test {
namespace {

constexpr std::size_t kNeighbours = 9;

std::vector<Eigen::Vector3f> single(const std::vector<Point>& points) {
  std::vector<Eigen::Vector3f> result;
  for (const Point& p : points) result.push_back(p.cast<float>());
  return result;
}

std::vector<std::uint32_t> nearest(const std::vector<Eigen::Vector3f>& points) {
  std::vector<std::uint32_t> result;
  std::vector<std::uint32_t> order(points.size());
  for (const Eigen::Vector3f& p : points) {
    std::iota(order.begin(), order.end(), 0u);
    std::partial_sort(order.begin(), order.begin() + kNeighbours, order.end(),
                      [&](std::uint32_t a, std::uint32_t b) {
                        return (points[a] - p).squaredNorm() < (points[b] - p).squaredNorm();
                      });
    result.insert(result.end(), order.begin(), order.begin() + kNeighbours);
  }
  return result;
}

void turn_at_random(std::vector<Eigen::Vector3f>& normals, std::uint64_t seed) {
  Random random(seed);
  for (auto& n : normals) {
    if (random.below(2) == 0) n = -n;
  }
}

std::size_t disagreements(const std::vector<Eigen::Vector3f>& a,
                          const std::vector<Eigen::Vector3f>& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += a[i].dot(b[i]) <= 0;
  return count;
}

void expect_recovered(const std::vector<Eigen::Vector3f>& positions,
                      const std::vector<Eigen::Vector3f>& outward) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::vector<Eigen::Vector3f> normals = outward;
    turn_at_random(normals, seed);
    ASSERT_GT(disagreements(normals, outward), normals.size() / 3);
    orient_normals(positions, nearest(positions), kNeighbours, normals);
    EXPECT_EQ(disagreements(normals, outward), 0u);
  }
}

TEST(OrientNormals, RecoversASphere) {
  const auto positions = single(sphere_cloud(500));
  expect_recovered(positions, positions);
}

TEST(OrientNormals, RecoversATorusWithItsInnerSide) {
  const auto positions = single(torus_cloud(40, 16));
  std::vector<Eigen::Vector3f> outward;
  for (const Eigen::Vector3f& p : positions) {
    const Eigen::Vector3f ring = Eigen::Vector3f(p.x(), p.y(), 0).normalized();
    outward.push_back((p - ring).normalized());
  }
  expect_recovered(positions, outward);
}

TEST(OrientNormals, OrientsSeparatePartsEachOutward) {
  auto positions = single(sphere_cloud(300));
  std::vector<Eigen::Vector3f> outward = positions;
  for (const Eigen::Vector3f& p : single(sphere_cloud(200))) {
    positions.push_back(p * 0.5f + Eigen::Vector3f(4, 1, 0));
    outward.push_back(p);
  }
  expect_recovered(positions, outward);
}

}  // namespace
}  // namespace emax::test
