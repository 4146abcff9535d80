#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/mirrors.h>
#include <symsurf/synthetic.h>

#include <cmath>

#include "expect_error.h"
#include "random_cloud.h"

namespace symsurf::metrics_tests {
namespace {

TEST(SurfaceErrors, AreThoseOfKnownOffsets) {
  Points points(4, 3);
  const Surface& f = surface("f4");
  points << 0, 0, 1, 0, 1, 1, 0, -2, -3, 5, 0.5, 0.5;
  // Errors 0, +1, -2, 0.
  const SurfaceErrors errors = surface_errors(points, f);
  EXPECT_DOUBLE_EQ(errors.rmse, std::sqrt(5.0 / 4));
  EXPECT_DOUBLE_EQ(errors.e_max, 2);
  EXPECT_DOUBLE_EQ(errors.e_avg, 0.75);
  EXPECT_DOUBLE_EQ(errors.bias, -0.25);
  EXPECT_EQ(errors.counted, 4);
}

TEST(SurfaceErrors, SkipAndCountWhereTheSurfaceIsUndefined) {
  Points points(3, 3);
  points << 0, 0, 2, 0.9, 0.9, 0, 3, 0, 0;
  const SurfaceErrors errors = surface_errors(points, surface("f6"));
  EXPECT_EQ(errors.counted, 1);
  EXPECT_EQ(errors.skipped, 2);
  EXPECT_DOUBLE_EQ(errors.rmse, 1);
  expect_error<InvalidInput>("undefined at all 2",
                             [&] { surface_errors(points.bottomRows(2).eval(), surface("f6")); });
}

TEST(SurfaceErrors, AreMeasuredInTheSurfacesFrame) {
  RandomCloud random(1);
  const Matrix3 rotation = random.rotation();
  const SurfaceMirror standing(surface("f1"), Mapping::Fixed);
  const auto moved = standing.transformed(3, rotation, Vector3(1, 2, 3));
  const Points points = random.box(50);
  const Points turned = (3 * points * rotation.transpose()).rowwise() + Eigen::RowVector3d(1, 2, 3);
  const SurfaceErrors plain = surface_errors(points, surface("f1"));
  const SurfaceErrors framed = surface_errors(turned, dynamic_cast<const SurfaceMirror&>(*moved));
  EXPECT_NEAR(framed.rmse, plain.rmse, 1e-13);
  EXPECT_NEAR(framed.bias, plain.bias, 1e-13);
}

TEST(SphereErrors, AreOverTheObjectsDiagonal) {
  Points object(2, 3);
  object << 0, 0, 0, 3, 4, 12;
  const SphereErrors errors = sphere_errors(Sphere({1, 0, 0}, 2), Sphere({0, 0, 0}, 2.5), object);
  EXPECT_DOUBLE_EQ(errors.e_c, 1.0 / 13);
  EXPECT_DOUBLE_EQ(errors.e_r, 0.5 / 13);
  expect_error<InvalidInput>("equal", [&] {
    sphere_errors(Sphere({1, 0, 0}, 2), Sphere({0, 0, 0}, 2), object.topRows(1).eval());
  });
}

TEST(SurfaceDistance, IsPerpendicularAndNeedsNoFrame) {
  RandomCloud random(2);
  const Points object = random.box(100);
  const double diagonal = (object.colwise().maxCoeff() - object.colwise().minCoeff()).norm();
  // 45 degrees steep: half the vertical offset squared.
  Points lifted = sampled_surface(surface("f4"), 1, 20);
  lifted.col(1).array() += 1.5;
  lifted.col(2).array() -= 1.5;
  lifted.col(2).array() += 0.1;
  const SurfaceMirror truth(surface("f4"), Mapping::Fixed);
  Points on_slope(2, 3);
  on_slope << 0, 1, 0.1, 3, -2, -0.9;
  EXPECT_NEAR(surface_distance(on_slope, truth, object), 0.1 / std::sqrt(2.0) / diagonal, 1e-12);
  EXPECT_NEAR(surface_distance(object, Plane(Vector3::UnitX(), 0), object),
              std::sqrt(object.col(0).squaredNorm() / 100) / diagonal, 1e-13);
}

TEST(Coverage, IsTheShareOfTheFootprint) {
  const Sample sample = mirror_perpendicular(surface("f1"), 2, 41, 0.3, 0.3);
  const Points surface_points =
      (sample.points.topRows(41 * 41) + sample.points.bottomRows(41 * 41)) / 2;
  EXPECT_EQ(coverage(surface_points, *sample.truth, sample.points), 1);
  EXPECT_EQ(coverage(Points(0, 3), *sample.truth, sample.points), 0);
  Points with_gap = surface_points;
  with_gap(0, 0) = std::nan("");
  EXPECT_EQ(coverage(with_gap, *sample.truth, sample.points), 1);
  with_gap.setConstant(std::nan(""));
  EXPECT_EQ(coverage(with_gap, *sample.truth, sample.points), 0);
  // The grid runs along x first: its first half covers half, and a rim as wide as the tolerance.
  const double part =
      coverage(surface_points.topRows(41 * 20).eval(), *sample.truth, sample.points);
  EXPECT_GT(part, 0.48);
  EXPECT_LT(part, 0.65);
  expect_error<InvalidParameter>(
      "tolerance", [&] { coverage(surface_points, *sample.truth, sample.points, -1); });
}

}  // namespace
}  // namespace symsurf::metrics_tests
