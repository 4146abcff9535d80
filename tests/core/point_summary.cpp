#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/point_summary.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <tuple>
#include <vector>

#include "expect_error.h"
#include "random_cloud.h"

namespace symsurf::point_summary_tests {
namespace {

PointSummary summary_of(PointsView points, Index cells) {
  PointSummary summary(cells);
  summary.add(points);
  return summary;
}

TEST(PointSummary, OfAnyPartsInAnyOrderIsTheSameToTheBit) {
  Points points = RandomCloud(3).box(20'000);
  points.topRows(300) *= 1e-13;  // of another magnitude
  points.row(5).setZero();
  const auto whole = summary_of(points, 500).bytes();

  std::mt19937_64 random(1);
  for (int trial = 0; trial < 5; ++trial) {
    std::vector<Index> order(points.rows());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), random);
    const Points shuffled = points(order, Eigen::all);
    std::vector<PointSummary> parts(1 + trial, PointSummary(500));
    for (Index at = 0; at < shuffled.rows();) {
      const Index rows = std::min<Index>(shuffled.rows() - at, 1 + random() % 4000);
      parts[random() % parts.size()].add({shuffled.row(at).data(), rows});
      at += rows;
    }
    std::shuffle(parts.begin(), parts.end(), random);
    PointSummary sum(500);
    for (const PointSummary& part : parts) sum.add(part);
    EXPECT_EQ(sum.bytes(), whole);
  }
}

TEST(PointSummary, HasTheMeansOfTheFinestGridOfPowersOfTwo) {
  const Points points = RandomCloud(7).box(5000);
  const PointSummary summary = summary_of(points, 300);
  ASSERT_LE(summary.size(), 300);

  const auto cells = [&](double edge) {
    std::map<std::tuple<double, double, double>, std::vector<Index>> cells;
    for (Index i = 0; i < points.rows(); ++i) {
      const Vector3 place = (points.row(i).transpose() / edge).array().floor();
      cells[{place.x(), place.y(), place.z()}].push_back(i);
    }
    return cells;
  };
  EXPECT_GT(cells(summary.edge() / 2).size(), 300u);
  const Points means = summary.means();
  const auto counts = summary.counts();
  Index row = 0;
  for (const auto& [place, members] : cells(summary.edge())) {
    const Points theirs = points(members, Eigen::all);
    EXPECT_EQ(counts[row], theirs.rows());
    EXPECT_LT((means.row(row) - theirs.colwise().mean()).norm(), 1e-15 * points.norm());
    ++row;
  }
  EXPECT_EQ(row, means.rows());
}

TEST(PointSummary, OfFewPointsHasThemAll) {
  const Points points = RandomCloud(9).box(200);
  for (const double scale : {1.0, 1e-3, 1e-40, 1e40}) {
    const Points scaled = scale * points, means = summary_of(scaled, 1000).means();
    ASSERT_EQ(means.rows(), points.rows());
    for (Index i = 0; i < points.rows(); ++i)
      EXPECT_LT((means.rowwise() - scaled.row(i)).rowwise().norm().minCoeff(), 1e-7 * scale);
  }
}

TEST(PointSummary, FarPointsCostNoResolution) {
  const Points body = RandomCloud(4).box(10'000);
  Points points(10'001, 3);
  points.topRows(10'000) = body;
  points.row(10'000).setConstant(1e30);
  const double edge = summary_of(body, 600).edge();
  EXPECT_LE(summary_of(points, 601).edge(), std::max(edge, std::ldexp(1, 100 - 62)));
  points.row(10'000).setConstant(1e6);
  EXPECT_EQ(summary_of(points, 601).edge(), edge);
}

TEST(PointSummary, CountsWhatIsNotFinite) {
  Points points = RandomCloud(2).box(50);
  points(3, 1) = std::nan("");
  points(7, 2) = -INFINITY;
  PointSummary summary = summary_of(points, 100);
  summary.add(summary_of(points, 100));
  EXPECT_EQ(summary.count(), 96);
  EXPECT_EQ(summary.nonfinite(), 4);
  EXPECT_EQ(summary.counts().sum(), 96);
  EXPECT_EQ(PointSummary::from_bytes(summary.bytes()).bytes(), summary.bytes());
  EXPECT_EQ(PointSummary().means().rows(), 0);
}

TEST(PointSummary, RefusesWhatItCannotAdd) {
  PointSummary summary = summary_of(RandomCloud(2).box(50), 100);
  const auto before = summary.bytes();
  Points far = RandomCloud(2).box(5);
  far(4, 0) = -1e51;
  expect_error<InvalidInput>("1e+51", [&] { summary.add(far); });
  expect_error<InvalidParameter>("101", [&] { summary.add(PointSummary(101)); });
  EXPECT_EQ(summary.bytes(), before);
  expect_error<InvalidParameter>("63", [] { PointSummary(63); });
  expect_error<InvalidInput>("100",
                             [&] { PointSummary::from_bytes(std::span(before).first(100)); });
}

}  // namespace
}  // namespace symsurf::point_summary_tests
