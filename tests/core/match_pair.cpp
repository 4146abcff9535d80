#include <gtest/gtest.h>
#include <symsurf/analyses.h>
#include <symsurf/context.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "expect_error.h"
#include "random_cloud.h"
#include "seeds.h"

namespace symsurf::match_pair_tests {
namespace {

// Random points of a body without a mirror, in either of whose halves no two places are alike.
Points body(RandomCloud& random, Index count) {
  Points points = random.sphere(count);
  for (auto row : points.rowwise()) {
    const double wave = std::sin(3 * row.x() + 1) + std::cos(4 * row.y() - row.z()) +
                        std::sin(2 * row.z() + 2 * row.x() * row.y());
    row *= std::exp(0.2 * wave);
  }
  return points;
}

Eigen::Isometry3d placement(RandomCloud& random) {
  Eigen::Isometry3d map(random.rotation());
  map.translation() = 5 * random.direction();
  map.linear().col(0) *= -1;
  return map;
}

Points placed(const Points& points, const Eigen::Isometry3d& map) {
  return (points * map.linear().transpose()).rowwise() + map.translation().transpose();
}

AnalysisResult match_pair(PointsView left, PointsView right, int threads = 0) {
  AnalysisOptions options;
  options.other = right;
  return analyse("match_pair", left, options, Context(nullptr, threads));
}

std::string verdict(const AnalysisResult& result) {
  return std::get<std::string>(result.statistics.at("verdict"));
}

double degrees_between(const Matrix4& a, const Matrix4& b) {
  const double chord = (a.topLeftCorner<3, 3>() - b.topLeftCorner<3, 3>()).norm();
  return 2 * std::asin(std::min(1.0, chord / std::sqrt(8))) * 180 / std::numbers::pi;
}

// The same points on both sides: to rounding, each its own partner.
TEST(MatchPair, LaysASetOnItsImage) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Points left = body(random, 2000);
    const Eigen::Isometry3d map = placement(random);
    const AnalysisResult found = match_pair(left, placed(left, map));
    ASSERT_EQ(found.transformations.size(), 1u);
    EXPECT_LT((found.transformations[0].matrix - map.matrix()).norm(), 1e-9);
    EXPECT_EQ(verdict(found), "found");
    for (Index i = 0; i < left.rows(); ++i)
      EXPECT_EQ(found.arrays.at("index")(i), static_cast<double>(i));
  }
}

TEST(MatchPair, LaysAnotherSampleOfWhichAThirdIsMissingOnTheImage) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Points twice = body(random, 8000);
    const Points left = twice.topRows(4000);
    const Vector3 pole = random.direction();
    std::vector<Index> kept;
    for (Index i = 4000; i < 8000; ++i)
      if (twice.row(i).normalized().dot(pole) < 0.4) kept.push_back(i);
    const Eigen::Isometry3d map = placement(random);
    const AnalysisResult found = match_pair(left, placed(twice(kept, Eigen::indexing::all), map));
    EXPECT_LT(degrees_between(found.transformations[0].matrix, map.matrix()), 1);
    EXPECT_EQ(verdict(found), "found");
  }
}

TEST(MatchPair, GivesTheInverseOfWhatTheOtherWayRoundGives) {
  RandomCloud random(1);
  const Points left = body(random, 3000), right = placed(left, placement(random));
  const Matrix4 there = match_pair(left, right).transformations[0].matrix,
                back = match_pair(right, left).transformations[0].matrix;
  EXPECT_LT((there * back - Matrix4::Identity()).norm(), 1e-9);
}

TEST(MatchPair, GivesTheSameBitsForAnyNumberOfThreads) {
  RandomCloud random(2);
  const Points left = body(random, 3000), right = placed(body(random, 3000), placement(random));
  EXPECT_EQ(match_pair(left, right, 1).transformations[0].matrix,
            match_pair(left, right, 3).transformations[0].matrix);
}

TEST(MatchPair, SaysThatOthersAreNoPair) {
  RandomCloud random(3);
  const Points left = body(random, 3000);
  const AnalysisResult found = match_pair(left, random.box(3000));
  EXPECT_EQ(verdict(found), "none");
  EXPECT_NE(std::get<std::string>(found.statistics.at("reason")).find("below"), std::string::npos);
}

// Of both shapes, whose points keep their numbers.
TEST(MatchPair, LeavesOutPointsThatAreNotFinite) {
  RandomCloud random(4);
  Points left = body(random, 2000);
  const Eigen::Isometry3d map = placement(random);
  Points right = placed(left, map);
  left.row(0).setConstant(std::numeric_limits<double>::quiet_NaN());
  right.row(1).setConstant(std::numeric_limits<double>::quiet_NaN());
  const AnalysisResult found = match_pair(left, right);
  EXPECT_EQ(found.arrays.at("index")(0), -1);
  EXPECT_NE(found.arrays.at("index")(1), 1);
  for (Index i = 2; i < left.rows(); ++i)
    EXPECT_EQ(found.arrays.at("index")(i), static_cast<double>(i));
}

TEST(MatchPair, NamesWhatIsWrong) {
  RandomCloud random(5);
  const Points left = body(random, 500), large = 10 * left;
  expect_error<InvalidInput>("allowed is one at most 4 times as large as the other",
                             [&] { match_pair(left, large); });
  expect_error<InvalidInput>("match_pair needs a second shape", [&] { match_pair(left, {}); });
  AnalysisOptions options;
  options.other = left;
  expect_error<InvalidInput>("symmetries takes no second shape",
                             [&] { analyse("symmetries", left, options); });
}

}  // namespace
}  // namespace symsurf::match_pair_tests
