#include <gtest/gtest.h>
#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

#include <cmath>
#include <vector>

#include "cloud/cloud.h"
#include "mirrored_ball.h"
#include "preprocess/preprocessing.h"
#include "random_cloud.h"
#include "registry.h"

namespace symsurf::outliers_tests {
namespace {

// Each of the others put before a point of the first.
Points mixed(const Points& points, const Points& others) {
  Points all(points.rows() + others.rows(), 3);
  const Index step = points.rows() / others.rows();
  Index row = 0;
  for (Index i = 0; i < points.rows(); ++i) {
    if (i % step == 0 && i / step < others.rows()) all.row(row++) = others.row(i / step);
    all.row(row++) = points.row(i);
  }
  return all;
}

// What is left without them, nothing where there are none.
Points without_outliers(const Points& points) {
  OutlierRemoval removal(4);
  Cloud cloud = checked_cloud(points, {}, 4, {});
  return removal.apply(cloud, {}) ? Points(cloud.points.matrix()) : Points(0, 3);
}

bool has_outliers(const Points& points) { return without_outliers(points).rows() > 0; }

double turned_by(const Result& result) {
  return std::acos(std::min(1.0, std::abs(dynamic_cast<Plane&>(*result.mirror).normal().x())));
}

TEST(Outliers, ChangeNothingButTheirNumbers) {
  for (const Method& method : methods()) {
    if (!implementation(method.name).preprocessing.remove_outliers) continue;
    RandomCloud random(1);
    const Points points = ball(random, 1000), far = 200 * random.sphere(7);
    const Points all = mixed(points, far);
    const Result without = detect(points, {.method = method.name});
    const Result with = detect(all, {.method = method.name});
    ASSERT_EQ(!with.mirror, !without.mirror) << method.name;
    if (with.mirror) {
      EXPECT_EQ(with.mirror->numbers(), without.mirror->numbers()) << method.name;
      EXPECT_EQ(with.mirror->mesh().vertices, without.mirror->mesh().vertices) << method.name;
    }
    EXPECT_EQ(with.score, without.score) << method.name;
    EXPECT_EQ(with.surface_points, without.surface_points) << method.name;
    EXPECT_EQ(std::get<Index>(with.statistics.at("outliers")), far.rows()) << method.name;
    EXPECT_EQ(without.statistics.count("outliers"), 0u) << method.name;
    ASSERT_EQ(with.pairs.rows(), without.pairs.rows()) << method.name;
    for (Index row = 0; row < with.pairs.rows(); ++row)
      for (const Index side : {0, 1})
        ASSERT_EQ(all.row(with.pairs(row, side)), points.row(without.pairs(row, side)))
            << method.name;
  }
}

TEST(Outliers, HaveNoPartnersOverAKnownMirror) {
  RandomCloud random(1);
  const Points points = ball(random, 1000), far = 200 * random.sphere(7);
  const Points all = mixed(points, far);
  const Plane mirror(Vector3::UnitX(), 0);
  const Result without = match(points, mirror, 0.01), with = match(all, mirror, 0.01);
  EXPECT_EQ(with.residuals, without.residuals);
  EXPECT_EQ(std::get<Index>(with.statistics.at("outliers")), far.rows());
  ASSERT_EQ(with.pairs.rows(), without.pairs.rows());
  for (Index row = 0; row < with.pairs.rows(); ++row)
    EXPECT_EQ(all.row(with.pairs(row, 1)), points.row(without.pairs(row, 1)));
}

// One, a tenth of the points; twice as far as the cloud is wide, or a thousand times.
TEST(Outliers, DoNotCountForTheDiagonal) {
  RandomCloud random(0);
  const Points points = random.box(2000);
  const double expected = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
  const Points all = mixed(points, 100 * random.box(10));
  EXPECT_DOUBLE_EQ(diagonal(points), expected);
  EXPECT_DOUBLE_EQ(diagonal(all), expected);
  Points some = all;
  some(0, 0) = std::nan("");
  EXPECT_DOUBLE_EQ(diagonal(some), expected);
  Options thesis;  // whose methods leave none out
  thesis.method = "sphere_thesis";
  EXPECT_GT(diagonal(all, thesis), 10 * expected);
}

TEST(Outliers, AreLeftOutWhereverTheyAre) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const double far : {8, 30, 1000})
      for (const Index count : {1, 20, 200}) {
        RandomCloud random(seed);
        const Points points = ball(random, 2000);
        const Points all = mixed(points, far * random.box(count) + 2 * far * random.sphere(count));
        EXPECT_LT(turned_by(detect(all, {.method = "plane"})), 1e-3)
            << seed << ' ' << far << ' ' << count;
      }
}

// What is looked at again after the farthest are gone: some far off what others are far off.
TEST(Outliers, OfOutliers) {
  RandomCloud random(0);
  const Points points = ball(random, 1000);
  const Points all = mixed(mixed(points, 20 * random.sphere(5)), 3000 * random.sphere(5));
  EXPECT_EQ(without_outliers(all), points);
}

// However often each point is given, the same are outliers.
TEST(Outliers, AreTheSameOfCopies) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    for (const Points& points :
         {random.box(12), mixed(ball(random, 400), 300 * random.sphere(5))}) {
      const Points once = without_outliers(points);
      for (const Index times : {2, 3, 30}) {
        const Points all = points.replicate(times, 1);
        EXPECT_EQ(without_outliers(all), Points(once.replicate(once.rows() > 0 ? times : 1, 1)))
            << seed << ' ' << times;
      }
    }
  }
}

// However many: often more than the object's.
TEST(Outliers, ArePixelsWithoutDepth) {
  RandomCloud random(0);
  Points points = ball(random, 2000);
  points.col(1).array() += 50;
  for (const Index count : {1, 100, 110, 300, 6000}) {
    Points all(points.rows() + count, 3);
    all << points, Points::Zero(count, 3);
    EXPECT_EQ(without_outliers(all), points) << count;
  }
}

TEST(Outliers, AreNoPartsOfTheObject) {
  RandomCloud random(0);
  const Points points = ball(random, 2000);
  // A second object, with a tenth of the points.
  Points other = ball(random, 200);
  other.col(0).array() += 30;
  EXPECT_FALSE(has_outliers(mixed(points, other)));
  // A rod without gaps.
  Points rod = 0.05 * random.box(200);
  for (Index i = 0; i < rod.rows(); ++i) rod(i, 2) = 0.05 * static_cast<double>(i);
  EXPECT_FALSE(has_outliers(mixed(points, rod)));
  // Clouds of few points, everywhere.
  for (std::uint64_t seed = 0; seed < 50; ++seed)
    EXPECT_FALSE(has_outliers(RandomCloud(seed).box(4 + static_cast<Index>(seed)))) << seed;
}

TEST(Outliers, LeaveAnArea) {
  RandomCloud random(0);
  // All in one position but two; all on a line but one.
  Points position = Points::Zero(100, 3), line = Points::Zero(100, 3);
  position.topRows(2) = 1000 * random.box(2);
  line.col(0) = Eigen::VectorXd::LinSpaced(100, 0, 1);
  line.row(0) << 0, 1000, 0;
  EXPECT_FALSE(has_outliers(position));
  EXPECT_FALSE(has_outliers(line));
}

// In the box of a dense cloud: next to no points, but in most of the box's cells.
TEST(Clutter, DoesNotHideThePlane) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const Index count : {10000, 60000})
      for (const double wide : {1.5, 3.0}) {
        RandomCloud random(seed);
        const Points all = mixed(ball(random, count), wide * random.box(count / 20));
        const Result result = detect(all, {.method = "plane"});
        EXPECT_LT(turned_by(result), 0.01) << seed << ' ' << count << ' ' << wide;
        EXPECT_GT(result.score, 0.7) << seed << ' ' << count << ' ' << wide;
      }
}

TEST(Clutter, IsNotWhereASurfaceIsSparse) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Points points = ball(random, 40000);
    std::vector<Index> kept;
    for (Index i = 0; i < points.rows(); ++i)
      if (points(i, 0) > 0 || random.uniform(0, 1) < 0.05) kept.push_back(i);
    const Points uneven = points(kept, Eigen::indexing::all);
    const Result result = detect(uneven, {.method = "plane"});
    EXPECT_LT(turned_by(result), 1e-3) << seed;
    EXPECT_GT(result.score, 0.7) << seed;
  }
}

TEST(Clutter, DoesNotHideTheSphere) {
  const Vector3 centre(2, 0, 0);
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    Points points = random.sphere(20000);
    for (Index i = 0; i < points.rows(); ++i) {
      const Vector3 u = points.row(i), x = 0.5 * (1 + 0.3 * std::sin(3 * u.y() + u.z())) * u;
      const double r = (x - centre).norm();
      points.row(i) = i % 2 ? Vector3(centre + (3 - r) / r * (x - centre)) : x;
    }
    const Result result = detect(mixed(points, 1.5 * random.box(1000)), {.method = "sphere"});
    const auto& sphere = dynamic_cast<const Sphere&>(*result.mirror);
    EXPECT_NEAR(sphere.radius(), 1.5, 0.02) << seed;
    EXPECT_LT((sphere.centre() - centre).norm(), 0.02) << seed;
  }
}

}  // namespace
}  // namespace symsurf::outliers_tests
