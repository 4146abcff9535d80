#include <gtest/gtest.h>
#include <symsurf/detect.h>

#include <algorithm>
#include <cmath>

#include "bumpy_ball.h"
#include "random_cloud.h"

namespace symsurf::cylinder_method_tests {
namespace {

// A dent on one side, a tenth of the radius deep.
void dent(Points& points, RandomCloud& random) {
  constexpr double radius = 0.4, depth = 0.1;
  Vector3 top = random.direction();
  top.x() = std::copysign(std::max(std::abs(top.x()), 0.5), top.x());
  top.normalize();
  for (Index i = 0; i < points.rows(); ++i) {
    const Vector3 u = points.row(i).normalized();
    const double profile = std::max(0.0, 1 - (u - top).squaredNorm() / (radius * radius));
    points.row(i) -= depth * profile * profile * u.transpose();
  }
}

// The surfaces of a ball hardly resist some changes of the mirror, along which a dent pulls it.
TEST(CylinderMethod, FindsTheMirrorOfADentedBall) {
  for (std::uint64_t seed = 0; seed < slow_seeds; ++seed) {
    SCOPED_TRACE(seed);
    RandomCloud random(seed);
    Points points = ball(seed).points;
    dent(points, random);
    const Points bent = wrapped(points);
    const Result result = detect(bent, {.method = "cylinder"});
    ASSERT_TRUE(result.mirror);
    const Points off =
        result.mirror->reflect(PointsView(bent)) - round_mirror.reflect(PointsView(bent));
    EXPECT_LT(off.rowwise().norm().maxCoeff(), 1e-9);
  }
}

}  // namespace
}  // namespace symsurf::cylinder_method_tests
