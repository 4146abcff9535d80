#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/detect.h>
#include <symsurf/mirrors.h>
#include <symsurf/operations.h>
#include <symsurf/synthetic.h>

#include <cmath>
#include <vector>

#include "expect_error.h"
#include "random_cloud.h"
#include "registry.h"

namespace symsurf::duplicates_tests {
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
  const Points points = surfaces(1, 300);
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

TEST(Duplicates, DoNotCountAsPoints) {
  const Points corners = RandomCloud(0).box(3);
  expect_error<InvalidInput>(
      "12 points given, 3 of them distinct; at least 12 distinct points are needed",
      [&] { detect(repeated(corners, 4), {.method = "perpendicular"}); });
}

Points lattice(Index side) {
  Points points(side * side, 3);
  for (Index i = 0; i < points.rows(); ++i)
    points.row(i) << static_cast<double>(i % side), static_cast<double>(i / side), 0;
  return points;
}

// Any number of copies of a few places, in any order: an answer with a mirror of finite numbers, or
// a named error.
TEST(Duplicates, OfFewPlacesHarmNoMethod) {
  Points cube(8, 3);
  for (Index i = 0; i < 8; ++i) cube.row(i) << (i & 1 ? 1 : 0), (i & 2 ? 1 : 0), (i & 4 ? 1 : 0);
  Points lattice_and_one(37, 3);
  lattice_and_one << lattice(6), Eigen::RowVector3d(1.5, 2.5, 1);
  std::vector<Points> clouds;
  for (const Index times : {7, 8, 10, 13, 30}) clouds.push_back(repeated(cube, times));
  for (std::uint64_t seed = 0; seed < 2; ++seed) {
    RandomCloud random(seed);
    for (const Index places : {2, 3, 4, 5, 8, 12, 13, 20, 22, 25}) {
      const Points few = random.box(places);
      Points copies(60, 3);
      for (Index i = 0; i < copies.rows(); ++i) copies.row(i) = few.row(random.below(places));
      clouds.push_back(copies);
    }
    Points copies(39, 3);
    for (Index i = 0; i < copies.rows(); ++i)
      copies.row(i) = lattice_and_one.row(i == 0 ? 36 : random.below(24));
    clouds.push_back(copies);
  }
  int answered = 0;
  for (const Points& cloud : clouds)
    for (const Method& method : methods()) {
      try {
        const Result result = detect(cloud, {.method = method.name});
        ++answered;
        if (!result.mirror) continue;
        EXPECT_TRUE(std::isfinite(result.score)) << method.name;
        EXPECT_TRUE(result.surface_points.allFinite()) << method.name;
        const Vector3 image = result.mirror->reflect(cloud.row(0).transpose());
        EXPECT_TRUE(image.allFinite() || image.array().isNaN().all()) << method.name;
      } catch (const InvalidInput&) {
      }
    }
  EXPECT_GT(answered, static_cast<int>(clouds.size()));
}

// Apart by less than the square root of the least double: their distances are 0. Found by fuzzing.
// A thousand points in five positions, but for rounding, are thinned; halves of halves towards a
// corner are equal to the search's rounding.
TEST(Duplicates, ButForRoundingHarmNoSearch) {
  RandomCloud random(0);
  const Points middles = random.box(5), noise = 1e-12 * random.box(1000);
  Points points(1000, 3);
  for (Index i = 0; i < points.rows(); ++i) points.row(i) = middles.row(i % 5) + noise.row(i);
  const Options fixed{.method = "fixed_direction", .parameters = {{"sample_size", Index{150}}}};
  EXPECT_TRUE(std::isfinite(detect(points, fixed).score));

  Points crowded = random.box(120);
  for (Index i = 0; i < crowded.rows(); ++i) crowded.row(i) *= std::pow(0.5, i);
  Points both(2 * crowded.rows(), 3);
  both << crowded, crowded + 1e-3 * random.box(crowded.rows());
  EXPECT_TRUE(std::isfinite(detect(both, {.method = "perpendicular"}).score));
}

TEST(Duplicates, MayDifferByLessThanADistance) {
  const Points corners = RandomCloud(1).box(12);
  Points copies(288, 3);
  for (Index i = 0; i < copies.rows(); ++i) {
    copies.row(i) = corners.row(i % 12);
    copies(i, 1) = 1e-200 * static_cast<double>(i % 36 / 12);
  }
  for (const char* method : {"fixed_direction", "perpendicular"})
    EXPECT_NO_THROW(detect(copies, {.method = method})) << method;
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
  for (std::uint64_t seed = 0; seed < draws(2); ++seed) {
    const Points points = surfaces(seed, 1000);
    Points some(1040, 3);
    some << points, points.topRows(40);
    const auto support = [](const Points& points, const char* method) {
      return std::get<double>(detect(points, {.method = method}).statistics.at("explained_share"));
    };
    for (const char* method : {"plane", "quadric", "fixed_direction", "perpendicular"})
      EXPECT_NEAR(support(some, method), support(points, method), 0.15) << method << ' ' << seed;
  }
}

// A quarter of a million copies of few points: whoever visits all copies of a neighbour takes
// hours.
TEST(Duplicates, CostNoMoreThanOtherPoints) {
  const Points half = RandomCloud(4).box(6);
  Points few(12, 3);
  few << half, half * Vector3(-1, 1, 1).asDiagonal();
  const Points many = repeated(few, 20'000);
  const Result one = detect(few, {.method = "plane"}), all = detect(many, {.method = "plane"});
  EXPECT_EQ(all.score, one.score);
  EXPECT_EQ(all.mirror->numbers(), one.mirror->numbers());
  EXPECT_EQ(all.statistics.count("outliers"), one.statistics.count("outliers"));
  const Result known = match(many, *one.mirror, 0.01);
  EXPECT_EQ(known.pairs.rows(), many.rows());
  const OperationResult pairs =
      operate("correspondences", {many}, *one.mirror, {{"one_to_one", true}});
  EXPECT_EQ(std::get<double>(pairs.statistics.at("paired_share")), 1);
}

TEST(Duplicates, AreMatchedAsTheyAreFound) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Points points = surfaces(seed, 800);
    const Result one = detect(points, {.method = "plane"});
    const double score = match(points, *one.mirror, 0.01).score;
    EXPECT_EQ(match(repeated(points, 3), *one.mirror, 0.01).score, score) << seed;
  }
}

}  // namespace
}  // namespace symsurf::duplicates_tests
