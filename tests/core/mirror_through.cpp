#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <limits>

#include "random_cloud.h"

namespace symsurf::mirror_through_tests {
namespace {

// As a file of single precision gives them back.
Points rounded(const Points& points) { return points.cast<float>().cast<double>(); }

TEST(MirrorThrough, GivesAPlaneBackFromItsTriangles) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Points object = random.box(100);
    const Plane plane(random.direction(), random.uniform(-1, 1));
    const auto found = mirror_through(rounded(plane.mesh(object).vertices));
    ASSERT_TRUE(found);
    ASSERT_EQ(found->kind(), "plane");
    EXPECT_LE((found->reflect(object) - plane.reflect(object)).cwiseAbs().maxCoeff(), 1e-5);
  }
}

TEST(MirrorThrough, GivesASphereBackFromItsTriangles) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Points object = random.box(100);
    const Sphere sphere(3 * random.direction(), random.uniform(3, 6));
    const auto found = mirror_through(rounded(sphere.mesh(object).vertices));
    ASSERT_TRUE(found);
    ASSERT_EQ(found->kind(), "sphere");
    EXPECT_LE((found->project(object) - sphere.project(object)).cwiseAbs().maxCoeff(), 1e-4);
  }
}

TEST(MirrorThrough, IsNullWhereThereIsNone) {
  RandomCloud random(0);
  EXPECT_FALSE(mirror_through(random.box(100)));
  EXPECT_FALSE(mirror_through(PointsView()));
  EXPECT_FALSE(mirror_through(Points(random.box(2))));
  EXPECT_FALSE(mirror_through(Points(Points::Ones(50, 3))));
  const Points line = Eigen::VectorXd::LinSpaced(50, 0, 1) * Eigen::RowVector3d(1, 2, 3);
  EXPECT_FALSE(mirror_through(line));
}

TEST(MirrorThrough, RefusesWhatIsNotFinite) {
  Points points = RandomCloud(0).box(10);
  points(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(mirror_through(points), InvalidInput);
}

}  // namespace
}  // namespace symsurf::mirror_through_tests
