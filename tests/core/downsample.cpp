#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/points.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "expect_error.h"
#include "random_cloud.h"

namespace symsurf::downsample_tests {
namespace {

// The definition to the letter: every k in turn, a sorted map of cells.
Points by_definition(const Points& points, Index count) {
  const Eigen::RowVector3d low = points.colwise().minCoeff();
  const Eigen::RowVector3d centroid = points.colwise().mean();
  const double l_avg = (points.rowwise() - centroid).rowwise().norm().mean();
  for (int k = 1;; ++k) {
    std::map<std::array<double, 3>, std::pair<Eigen::RowVector3d, int>> cells;
    for (Index i = 0; i < points.rows(); ++i) {
      const Eigen::RowVector3d cell = ((points.row(i) - low) / (l_avg / k)).array().floor();
      auto& [sum, members] =
          cells.try_emplace({cell[0], cell[1], cell[2]}, Eigen::RowVector3d::Zero(), 0)
              .first->second;
      sum += points.row(i);
      ++members;
    }
    if (static_cast<Index>(cells.size()) < count) continue;
    Points means(static_cast<Index>(cells.size()), 3);
    Index row = 0;
    for (const auto& [cell, mean] : cells) means.row(row++) = mean.first / mean.second;
    return means;
  }
}

Points uneven(RandomCloud& random, Index n) {
  Points points = random.box(n);
  for (Index i = 0; i < n; ++i) points.row(i) *= std::pow(points(i, 0), 4) + 0.01;
  return points;
}

Points permuted(const Points& points, Index step) {
  Points moved(points.rows(), 3);
  for (Index i = 0; i < points.rows(); ++i) moved.row(i) = points.row(i * step % points.rows());
  return moved;
}

void expect_near(const Points& a, const Points& b, double tolerance) {
  ASSERT_EQ(a.rows(), b.rows());
  EXPECT_LE((a - b).cwiseAbs().maxCoeff(), tolerance);
}

TEST(Downsample, IsTheMeansOfTheFirstGridWithEnoughCells) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    for (const Points& points : {random.box(1500), random.sphere(1500), uneven(random, 1500)})
      for (const Index count : {1, 2, 7, 8, 9, 50, 300, 1000})
        expect_near(downsample(points, count), by_definition(points, count), 1e-13);
  }
}

TEST(Downsample, GivesFewPointsBackDigitForDigit) {
  Points points(5, 3);
  points << 0.1, 0.2, 0.3, -4000000.001, 1, 2, 0.1, 0.2, 0.3, -5, -0.0, 1, -5, 0.0, 1;
  Points distinct(3, 3);
  distinct << -4000000.001, 1, 2, -5, 0, 1, 0.1, 0.2, 0.3;
  for (const Index count : {3, 4, 1000}) EXPECT_EQ(downsample(points, count), distinct);
  EXPECT_EQ(downsample(Points(points.topRows(1)), 1), Points(points.topRows(1)));
}

TEST(Downsample, DoesNotDependOnTheOrderOfThePoints) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Points points = RandomCloud(seed).sphere(2003);
    expect_near(downsample(permuted(points, 10), 200), downsample(points, 200), 1e-14);
  }
}

TEST(Downsample, DoesNotDependOnTheUnit) {
  const Points points = RandomCloud(0).sphere(2000);
  const Points sample = downsample(points, 200);
  for (const double unit : {0x1p-900, 0x1p-30, 0x1p40, 0x1p900})
    EXPECT_EQ(downsample(Points(points * unit), 200), Points(sample * unit));
}

TEST(Downsample, SeesPastFarOutliers) {
  for (const double distance : {1e3, 1e6, 1e9}) {
    Points points = RandomCloud(1).box(3000);
    points.row(17) << distance, 0, -distance;
    const Points sample = downsample(points, 500);
    EXPECT_GE(sample.rows(), 500);
    EXPECT_LE(sample.rows(), 1500);
  }
}

TEST(Downsample, EndsWherePointsAreEqualButForRounding) {
  RandomCloud random(2);
  Points points = random.lattice(2000, 2);
  points += random.box(2000) * 1e-18;
  points(0, 0) = 1e-300;
  EXPECT_GE(downsample(points, 100).rows(), 8);
  points.row(0) << 1e250, 0, 0;
  EXPECT_EQ(downsample(points, 100).rows(), 2);
}

TEST(Downsample, SaysWhatIsWrong) {
  const Points points = RandomCloud(0).box(10);
  for (const Index count : {0, -3})
    expect_error<InvalidParameter>("count is " + std::to_string(count) + "; allowed is 1 and above",
                                   [&] { downsample(points, count); });
  expect_error<InvalidInput>("no points", [] { downsample({}, 5); });
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Points broken = points;
    broken(4, 1) = bad;
    expect_error<InvalidInput>("point 4", [&] { downsample(broken, 5); });
  }
  Points huge = points;
  huge(0, 0) = 1e308;
  huge(1, 0) = -1e308;
  expect_error<InvalidInput>("span", [&] { downsample(huge, 5); });
}

}  // namespace
}  // namespace symsurf::downsample_tests
