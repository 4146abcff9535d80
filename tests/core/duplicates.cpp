#include <gtest/gtest.h>
#include <symsurf/damage.h>
#include <symsurf/detect.h>
#include <symsurf/plane.h>

#include <cmath>

#include "methods/registry.h"
#include "random_cloud.h"

namespace symsurf {
namespace {

// Two noisy surfaces about a saddle: where the points of one lie, the other has none.
Points surfaces(std::uint64_t seed, Index count) {
  RandomCloud random(seed);
  Points points = random.box(count);
  for (Index i = 0; i < count; ++i) {
    const double x = points(i, 0), y = points(i, 1), d = 0.35 + 0.1 * std::sin(3 * x + 1) * y;
    points(i, 2) = 0.2 * (x * x - y * y) + (i % 2 ? d : -d);
  }
  return add_noise(points, 0, 0.01, {}, seed);
}

Points repeated(const Points& points, Index times) { return points.replicate(times, 1); }

// As in the corners of triangles that nobody merged.
TEST(Duplicates, HaveTheSamePartner) {
  const Points points = surfaces(1, 1000);
  const Index n = points.rows(), times = 3;
  for (const Method& method : methods()) {
    if (!implementation(method.name).preprocessing.merge_duplicates) continue;
    const Result one = detect(points, {.method = method.name});
    const Result many = detect(repeated(points, times), {.method = method.name});
    EXPECT_EQ(many.score, one.score) << method.name;
    ASSERT_EQ(many.pairs.rows(), times * one.pairs.rows()) << method.name;
    for (Index row = 0; row < many.pairs.rows(); ++row) {
      const Index of_one = row % one.pairs.rows();
      EXPECT_EQ(many.pairs(row, 0) % n, one.pairs(of_one, 0));
      EXPECT_EQ(many.pairs(row, 1), one.pairs(of_one, 1));
      EXPECT_EQ(many.residuals[row], one.residuals[of_one]);
      EXPECT_EQ(many.surface_points.row(row), one.surface_points.row(of_one));
    }
  }
}

TEST(Duplicates, OfFewPointsAreStillPoints) {
  const Points corners = RandomCloud(0).box(3);
  EXPECT_NO_THROW(detect(repeated(corners, 4), {.method = "perpendicular"}));
}

TEST(Duplicates, HardlyChangeThePlane) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    Points half = surfaces(seed, 2000), points(4000, 3);
    half.col(0).array() += 1.5;
    points << half, half;
    points.col(0).tail(2000) *= -1;
    points = add_noise(points, 0, 0.02, {}, seed);
    const Result one = detect(points, {.method = "plane"});
    for (const Index times : {2, 6}) {
      const Result many = detect(repeated(points, times), {.method = "plane"});
      EXPECT_NEAR(many.score, one.score, 0.1) << seed << ' ' << times;
      EXPECT_NEAR(std::abs(dynamic_cast<Plane&>(*many.mirror).normal().x()), 1, 1e-4) << seed;
    }
  }
}

// Where there are few duplicates, the method gets them.
TEST(Duplicates, OfSomePointsHardlyChangeWhatIsExplained) {
  for (std::uint64_t seed = 0; seed < 2; ++seed) {
    const Points points = surfaces(seed, 1000);
    Points some(1040, 3);
    some << points, points.topRows(40);
    const auto support = [](const Points& points, const char* method) {
      return std::get<double>(detect(points, {.method = method}).statistics.at("explained_share"));
    };
    for (const char* method : {"plane", "quadric", "fixed_direction", "perpendicular"})
      EXPECT_NEAR(support(some, method), support(points, method), 0.1) << method << ' ' << seed;
  }
}

}  // namespace
}  // namespace symsurf
