#include <gtest/gtest.h>
#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include "base/math.h"
#include "random_cloud.h"

namespace symsurf::plane_search_tests {
namespace {

// A closed shape with the one mirror x = 0: a lumpy ball, drawn on both sides alike or anew.
Vector3 on_lumpy_ball(const Vector3& direction) {
  const double x = std::abs(direction.x()), y = direction.y(), z = direction.z();
  const double radius = 1 + 0.25 * y * z + 0.3 * std::sin(2 * z + 0.5) * x + 0.2 * y * y * y -
                        0.25 * std::cos(3 * x + y);
  return radius * Vector3(direction.x(), 1.3 * y, 0.8 * z);
}

Points lumpy_ball(RandomCloud& random, Index n, bool same_points_on_both_sides) {
  Points points(n, 3);
  for (Index i = 0; i < n; ++i) {
    points.row(i) = on_lumpy_ball(random.direction()).transpose();
    if (!same_points_on_both_sides || ++i == n) continue;
    points.row(i) = points.row(i - 1);
    points(i, 0) *= -1;
  }
  return points;
}

double diagonal(const Points& points) {
  return (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
}

struct Pose {
  double scale;
  Matrix3 rotation;
  Vector3 shift;

  explicit Pose(RandomCloud& random)
      : scale(std::exp(random.uniform(-5, 5))),
        rotation(random.rotation()),
        shift(3 * scale * random.in_box()) {}

  Points operator()(const Points& points) const {
    return (scale * points * rotation.transpose()).rowwise() + shift.transpose();
  }
  Plane operator()(const Plane& plane) const {
    const Vector3 normal = rotation * plane.normal();
    return Plane(normal, scale * plane.offset() - normal.dot(shift));
  }
};

Result detected(const Points& points, int threads = 1) {
  Options options;
  options.method = "plane";
  return detect(points, options, Context({}, threads));
}

// The largest distance between the images of the cloud's points, over the diagonal.
double difference(const Mirror& a, const Mirror& b, const Points& points) {
  return (a.reflect(PointsView(points)) - b.reflect(PointsView(points)))
             .rowwise()
             .norm()
             .maxCoeff() /
         diagonal(points);
}

double angle(const Result& result, const Plane& truth) {
  const Plane& plane = dynamic_cast<const Plane&>(*result.mirror);
  const double sine = plane.normal().cross(truth.normal()).norm();
  return std::asin(std::min(1.0, sine)) * 180 / std::numbers::pi;
}

double offset(const Result& result, const Plane& truth, const Points& points) {
  const Vector3 centre = points.colwise().mean();
  return std::abs(std::abs(result.mirror->signed_distance(centre)) -
                  std::abs(truth.signed_distance(centre))) /
         diagonal(points);
}

const Plane truth(Vector3::UnitX(), 0);

TEST(PlaneSearch, ExactMirrorsAreFoundToRoundingInAnyPose) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Points points = lumpy_ball(random, 2000, true);
    const Pose pose(random);
    const Points posed = pose(points);
    const Result result = detected(posed);
    EXPECT_LT(difference(*result.mirror, pose(truth), posed), 1e-9) << seed;
    EXPECT_GT(result.score, 0.99);
    EXPECT_EQ(result.pairs.rows(), 2000);
    EXPECT_LT(result.residuals.maxCoeff(), 1e-9 * diagonal(posed));
  }
}

// Nothing in such a shape tells which side is which.
TEST(PlaneSearch, ExactMirrorsFaceTheSameWayInAnyOrder) {
  RandomCloud random(0);
  const Points points = Pose(random)(lumpy_ball(random, 2000, true));
  const Vector3 normal = dynamic_cast<const Plane&>(*detected(points).mirror).normal();
  std::vector<Index> order(points.rows());
  std::iota(order.begin(), order.end(), 0);
  std::mt19937 shuffle(0);
  for (int trial = 0; trial < 8; ++trial) {
    std::shuffle(order.begin(), order.end(), shuffle);
    const Result result = detected(points(order, Eigen::all));
    EXPECT_GT(dynamic_cast<const Plane&>(*result.mirror).normal().dot(normal), 0.9);
  }
}

TEST(PlaneSearch, SurvivesDamage) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Points whole = lumpy_ball(random, 4096, false);
    const double size = diagonal(whole);
    const Vector3 hole = on_lumpy_ball(random.direction());
    Points damaged(whole.rows(), 3);
    Index kept = 0;
    for (Index i = 0; i < whole.rows(); ++i) {
      const Vector3 x = whole.row(i).transpose();
      if ((x - hole).norm() < 0.2 * size) continue;
      damaged.row(kept++) =
          (x + 0.01 * size * random.uniform(0, 1) * random.direction()).transpose();
    }
    damaged.conservativeResize(kept, 3);
    const Pose pose(random);
    const Points posed = pose(damaged);
    const Result result = detected(posed);
    EXPECT_LT(angle(result, pose(truth)), 1) << seed;
    EXPECT_LT(offset(result, pose(truth), posed), 0.005) << seed;
  }
}

template <typename Keep>
Points part_of(const Points& whole, const Keep& keep) {
  std::vector<Index> rows;
  for (Index i = 0; i < whole.rows(); ++i)
    if (keep(Vector3(whole.row(i)))) rows.push_back(i);
  return whole(rows, Eigen::all);
}

TEST(PlaneSearch, FindsThePlaneOfHalfAnObject) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Points whole = lumpy_ball(random, 4096, false);
    const Points half = part_of(whole, [](const Vector3& x) { return x.x() > 0 || x.y() > 0.4; });
    const Result result = detected(half);
    EXPECT_LT(angle(result, truth), 2) << seed;
    EXPECT_LT(offset(result, truth, half), 0.01) << seed;
  }
}

// Few pairs there tell of the mirror, and all of them at short range: another plane may map more of
// what is left nearly, and is the result then; but the true one is among the candidates.
TEST(PlaneSearch, MostlyMeetsThePlaneOfHalfAnObjectWithAStripOfTheOtherHalf) {
  SYMSURF_FULL_RUN_ONLY();
  int found = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    RandomCloud random(seed);
    const Points whole = lumpy_ball(random, 4096, false);
    std::vector<double> depths;
    for (Index i = 0; i < whole.rows(); ++i)
      if (whole(i, 0) < 0) depths.push_back(-whole(i, 0));
    const double strip = quantile(std::move(depths), 0.3);
    const Points half = part_of(whole, [&](const Vector3& x) { return x.x() > -strip; });
    Result result = detected(half);
    std::vector<Result> all = std::move(result.candidates);
    all.push_back(std::move(result));
    found += std::any_of(all.begin(), all.end(), [&](const Result& r) {
      return angle(r, truth) < 2 && offset(r, truth, half) < 0.01;
    });
  }
  EXPECT_GE(found, 7);
}

TEST(PlaneSearch, DoesNotDependOnPose) {
  RandomCloud random(1);
  const Points points = lumpy_ball(random, 1500, false);
  const Result first = detected(points);
  for (int trial = 0; trial < 4; ++trial) {
    const Pose pose(random);
    const Points posed = pose(points);
    const Result second = detected(posed);
    const Plane expected = pose(dynamic_cast<const Plane&>(*first.mirror));
    EXPECT_LT(difference(*second.mirror, expected, posed), 1e-9);
    EXPECT_NEAR(second.score, first.score, 1e-6);  // it holds square roots of tiny spreads
  }
}

TEST(PlaneSearch, DoesNotDependOnTheOrderOfThePoints) {
  RandomCloud random(2);
  const Points points = lumpy_ball(random, 1500, false);
  const Points reversed = points.colwise().reverse();
  EXPECT_LT(difference(*detected(points).mirror, *detected(reversed).mirror, points), 1e-9);
}

TEST(PlaneSearch, GivesTheSameBitsForAnyNumberOfThreads) {
  RandomCloud random(3);
  const Points points = lumpy_ball(random, 100000, false);
  const Result one = detected(points, 1);
  for (const int threads : {2, 3, 7}) {
    const Result many = detected(points, threads);
    EXPECT_EQ(std::get<Vector3>(one.mirror->numbers().at("normal")),
              std::get<Vector3>(many.mirror->numbers().at("normal")));
    EXPECT_EQ(one.score, many.score);
    EXPECT_EQ(one.pairs, many.pairs);
    EXPECT_EQ(one.residuals, many.residuals);
  }
}

TEST(PlaneSearch, ReportsEveryMirrorOfABrick) {
  RandomCloud random(4);
  Points brick(6000, 3);
  for (Index i = 0; i < brick.rows(); ++i) {
    Vector3 x = random.in_box();
    Index face;
    x.cwiseAbs().maxCoeff(&face);
    x[face] = x[face] < 0 ? -1 : 1;
    brick.row(i) = x.cwiseProduct(Vector3(3, 2, 1)).transpose();
  }
  const Result result = detected(brick);
  for (int axis = 0; axis < 3; ++axis) {
    const Plane plane(Vector3::Unit(axis), 0);
    double best = angle(result, plane);
    for (const Result& candidate : result.candidates)
      best = std::min(best, angle(candidate, plane));
    EXPECT_LT(best, 1) << axis;
  }
}

TEST(PlaneSearch, ScoresNoSymmetryClearlyLower) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Matrix3 skew = random.rotation();
    Points odd(3000, 3);
    for (Index i = 0; i < odd.rows(); ++i) {
      const Vector3 d = random.direction(), e = skew * d;
      const double radius = 1 + 0.2 * std::sin(3 * d.x() + 2 * e.y()) * d.z() +
                            0.25 * std::cos(2 * e.x() - 3 * d.y() * e.z()) + 0.2 * d.x() * e.z();
      odd.row(i) = (radius * d).transpose();
    }
    const double score_odd = detected(odd).score;
    const double score_even = detected(lumpy_ball(random, 3000, false)).score;
    EXPECT_LT(score_odd, 0.4) << seed;
    EXPECT_GT(score_even, 0.8) << seed;
  }
}

TEST(PlaneSearch, WorksOnFewPoints) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Points points = lumpy_ball(random, 100, true);
    EXPECT_LT(angle(detected(points), truth), 0.05) << seed;
  }
}

TEST(PlaneSearch, FourPointsAreEnoughForAnAnswer) {
  Points points(4, 3);
  points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  const Result result = detected(points);
  ASSERT_TRUE(result.mirror);
  EXPECT_TRUE(std::isfinite(result.score));
}

}  // namespace
}  // namespace symsurf::plane_search_tests
