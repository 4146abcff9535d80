#include "cloud/surfels.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cloud/cloud.h"
#include "random_cloud.h"

namespace symsurf::surfels_tests {
namespace {

double root_mean_square(const Eigen::MatrixXd& rows) {
  return std::sqrt(rows.rowwise().squaredNorm().mean());
}

// Points of the cloud, each smoothed in its patch by that much, in the cloud's unit.
Points smoothed(const Points& points, double width) {
  const Cloud cloud = checked_cloud(points, {}, 4, {});
  const Surfels surfels(cloud, 400, {});
  Points result(points.rows(), 3);
  for (Index i = 0; i < points.rows(); ++i) {
    const Vector3 x = cloud.frame.to_frame(points.row(i).transpose());
    const Surfel& surfel = surfels[surfels.containing(x)];
    result.row(i) =
        cloud.frame.from_frame(surfel.smoothed(x, width / cloud.frame.size)).transpose();
  }
  return result;
}

// A surface across z, a rod along x: noise is taken off across them, and little is moved along
// them.
TEST(Surfels, SmoothingTakesNoiseOffSurfacesAndRods) {
  constexpr double noise = 0.02;
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const Index along : {1, 2}) {
      RandomCloud random(seed);
      Points points = random.box(4000);
      if (along == 1) points.col(0) *= 4;
      for (Index i = 0; i < points.rows(); ++i)
        for (Index axis = along; axis < 3; ++axis)
          points(i, axis) = noise * std::sqrt(3) * random.uniform(-1, 1);
      const Points moved = smoothed(points, 2 * noise);
      const Index across = 3 - along;
      EXPECT_LT(root_mean_square(moved.rightCols(across)),
                0.35 * root_mean_square(points.rightCols(across)))
          << seed << ' ' << along;
      EXPECT_LT(root_mean_square((moved - points).leftCols(along)), noise) << seed << ' ' << along;
    }
}

}  // namespace
}  // namespace symsurf::surfels_tests
