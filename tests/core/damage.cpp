#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/synthetic.h>

#include <cmath>

#include "expect_error.h"
#include "random_cloud.h"

namespace symsurf::damage_tests {
namespace {

const Box half{{0, -2, -2}, {2, 2, 2}};

TEST(AddNoise, MovesOnlyTheBoxAndOnlySoFar) {
  const Points points = RandomCloud(1).box(4000);
  const Points moved = add_noise(points, 0.1, 0.3, half, 7);
  double sum = 0, squares = 0, inside = 0;
  Vector3 drift = Vector3::Zero();
  for (Index i = 0; i < points.rows(); ++i) {
    const Vector3 delta = moved.row(i) - points.row(i);
    if (!half.holds(points.row(i))) {
      EXPECT_EQ(delta, Vector3::Zero());
      continue;
    }
    EXPECT_GE(delta.norm(), 0.1 - 1e-12);
    EXPECT_LE(delta.norm(), 0.3 + 1e-12);
    ++inside;
    drift += delta;
    sum += delta.norm();
    squares += delta.squaredNorm();
  }
  ASSERT_GT(inside, 1500);
  const double deviation = 0.2 / std::sqrt(12.0);  // of a uniform magnitude
  EXPECT_NEAR(sum / inside, 0.2, 5 * deviation / std::sqrt(inside));
  EXPECT_LT(drift.norm() / inside, 5 * 0.2 / std::sqrt(inside));
  EXPECT_NEAR(squares / inside, 0.2 * 0.2 + deviation * deviation, 0.003);
}

TEST(RemovePoints, RemovesTheShareAskedForInTheBox) {
  const Points points = RandomCloud(2).box(4000);
  const Damaged damaged = remove_points(points, 0.25, half, 3);
  double before = 0, after = 0;
  for (Index i = 0; i < points.rows(); ++i) before += half.holds(points.row(i));
  for (std::size_t k = 0; k < damaged.kept.size(); ++k) {
    EXPECT_EQ(damaged.points.row(static_cast<Index>(k)), points.row(damaged.kept[k]));
    after += half.holds(points.row(damaged.kept[k]));
  }
  EXPECT_EQ(points.rows() - damaged.points.rows(), static_cast<Index>(before - after));
  EXPECT_NEAR(after / before, 0.75, 5 * std::sqrt(0.25 * 0.75 / before));
  EXPECT_EQ(remove_points(points, 0, half).points, points);
  EXPECT_EQ(remove_points(points, 1, {}).points.rows(), 0);
}

TEST(Rotate, TurnsAboutXThenYThenZ) {
  Points points(1, 3);
  points << 0, 0, 1;
  // z -> -y by roll; pitch leaves it; -y -> x by yaw.
  EXPECT_NEAR((rotate(points, 90, 0, 0).row(0) - Eigen::RowVector3d(0, -1, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((rotate(points, 90, 90, 90).row(0) - Eigen::RowVector3d(1, 0, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((rotate(points, 0, 90, 0).row(0) - Eigen::RowVector3d(1, 0, 0)).norm(), 0, 1e-15);
  const Matrix3 r = rotation_matrix(10, 20, 30);
  EXPECT_NEAR((r * r.transpose() - Matrix3::Identity()).norm(), 0, 1e-15);
  EXPECT_NEAR(r.determinant(), 1, 1e-15);
}

TEST(Thin, KeepsOneInSoManyOfOneHalf) {
  const Points points = RandomCloud(4).box(8000);
  const Damaged damaged = thin(points, 4, Vector3(0, 0, -1), 5);
  double above = 0, below = 0, all_below = 0;
  for (const auto& x : points.rowwise()) all_below += x.z() < 0;
  for (const auto& x : damaged.points.rowwise()) (x.z() < 0 ? below : above) += 1;
  EXPECT_NEAR(above, 8000 - all_below, 20);  // the box's middle is not quite 0
  EXPECT_NEAR(below / all_below, 0.25, 0.04);
  EXPECT_EQ(thin(points, 1).points, points);
}

TEST(Damage, GivesTheSameNumbersForASeedEverywhere) {
  // SplitMix64's first number for seed 0 is 0xe220a8397b1dcdaf.
  Points points(1, 3);
  points << 0, 0, 0;
  const double first = static_cast<double>(0xe220a8397b1dcdaf >> 11) * 0x1p-53;
  EXPECT_EQ(remove_points(points, std::nextafter(first, 1.0)).points.rows(), 0);
  EXPECT_EQ(remove_points(points, first).points.rows(), 1);

  const Points cloud = RandomCloud(5).box(50);
  EXPECT_EQ(add_noise(cloud, 0, 1, {}, 9), add_noise(cloud, 0, 1, {}, 9));
  EXPECT_NE(add_noise(cloud, 0, 1, {}, 9), add_noise(cloud, 0, 1, {}, 10));
}

TEST(Damages, RunFromTheirDescriptions) {
  const Points cloud = RandomCloud(6).box(200);
  for (const Damage& kind : damages())
    EXPECT_EQ(static_cast<std::size_t>(damage(kind.name, cloud).points.rows()),
              damage(kind.name, cloud).kept.size());
  EXPECT_EQ(damage("removal", cloud).points.rows(), 0);
  EXPECT_EQ(
      damage("removal", cloud, {{"box_low", Vector3(0, -2, -2)}, {"box_high", Vector3(2, 2, 2)}})
          .points.rows(),
      (cloud.col(0).array() < 0).count());
  expect_error<InvalidParameter>("noise, removal, rotation, thinning",
                                 [&] { damage("fire", cloud); });
}

TEST(Damage, SaysWhatIsWrong) {
  const Points cloud = RandomCloud(7).box(20);
  const Box inverted{{1, 0, 0}, {0, 1, 1}};
  expect_error<InvalidParameter>("minimum must not exceed",
                                 [&] { add_noise(cloud, 0, 1, inverted); });
  expect_error<InvalidParameter>("minimum must not exceed",
                                 [&] { remove_points(cloud, 0.5, inverted); });
  expect_error<InvalidParameter>("noise from 2 to 1", [&] { add_noise(cloud, 2, 1); });
  expect_error<InvalidParameter>("probability is 1.5", [&] { remove_points(cloud, 1.5); });
  expect_error<InvalidParameter>("ratio is 0.5", [&] { thin(cloud, 0.5); });
  expect_error<InvalidParameter>("angle", [&] { rotate(cloud, NAN, 0, 0); });
  expect_error<InvalidInput>("0 points", [] { rotate({}, 1, 2, 3); });
}

}  // namespace
}  // namespace symsurf::damage_tests
