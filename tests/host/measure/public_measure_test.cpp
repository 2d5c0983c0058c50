#include <emax/measure.h>
#include <gtest/gtest.h>

#include "host/measure/point_distances.h"
#include "sw_model/base/public_arguments.h"
#include "sw_model/certify/certificate.h"
#include "sw_model/model/emax_model.h"
#include "sw_model/model/triangle_frame.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

struct Given {
  explicit Given(const test::Stimulus& s)
      : cloud(as_public({s.cloud, {}}).coordinates), mesh(as_public(s.mesh())) {}
  std::vector<double> cloud;
  Surface mesh;
};

TEST(PublicMeasure, GivesTheBitsOfTheGoldenModel) {
  for (const test::Stimulus& s : test::all_stimuli(301)) {
    SCOPED_TRACE(s.name + ", seed 301");
    const Given given(s);
    const Normalization normalization = normalization_of(s.cloud);
    const auto records = make_records(s.mesh(), normalization);
    const EmaxResult expected = emax_model(normalized_points(s.cloud, normalization), records);
    for (const std::size_t threads : {1, 3}) {
      ErrorMeter meter(given.cloud, threads);
      const Measurement found = meter.e_max(given.mesh);
      EXPECT_EQ(found.squared_bits, expected.squared_bits);
      EXPECT_EQ(found.worst_point, expected.worst_point);
      const std::vector<double> distances = meter.distances(given.mesh);
      EXPECT_EQ(distances, point_distances(PreparedCloud(s.cloud), s.mesh()));
      EXPECT_EQ(distances[found.worst_point], found.e_max);
      EXPECT_EQ(meter.quantile(given.mesh, 1), found.e_max);
      const CertifiedError truth = certify(s.cloud, s.mesh());
      EXPECT_NEAR(found.e_max, truth.e_max_upper, meter.margin(given.mesh, found.e_max));
    }
  }
}

TEST(PublicMeasure, OfEachIsThatOfOne) {
  std::vector<Surface> surfaces;
  const Given cloud(test::bumpy_sphere(20, 30, 2000, 302));
  for (const std::uint32_t rings : {6, 10, 14, 18}) {
    surfaces.push_back(Given(test::bumpy_sphere(rings, rings + 4, 0, 302)).mesh);
  }
  const std::vector<SurfaceSpan> meshes(surfaces.begin(), surfaces.end());
  std::vector<Measurement> expected;
  for (const SurfaceSpan& mesh : meshes) expected.push_back(ErrorMeter(cloud.cloud).e_max(mesh));
  for (const std::size_t threads : {1, 2, 7}) {
    EXPECT_EQ(e_max_of_each(cloud.cloud, meshes, threads), expected);
  }
}

TEST(PublicMeasure, RefusesWhatCannotBeMeasured) {
  const Given given(test::bumpy_sphere(6, 8, 20, 303));
  EXPECT_THROW(ErrorMeter({}), Error);
  EXPECT_THROW(ErrorMeter(given.cloud, 0), Error);
  ErrorMeter meter(given.cloud);
  EXPECT_THROW(meter.e_max({}), Error);
  EXPECT_THROW(meter.quantile(given.mesh, 0), Error);
  EXPECT_THROW(meter.quantile(given.mesh, 1.5), Error);
  const std::vector<SurfaceSpan> none = {{}};
  EXPECT_THROW(e_max_of_each(given.cloud, none), Error);
}

}  // namespace
}  // namespace emax
