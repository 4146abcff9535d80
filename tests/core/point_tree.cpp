#include "cloud/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "hard_clouds.h"
#include "random_cloud.h"

namespace symsurf::point_tree_tests {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(PointTree, FindsTheNearestOfEveryCloud) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const Points& points : clouds(seed)) {
      const PointTree tree(points);
      RandomCloud random(seed);
      for (const Vector3& query : queries(points, random)) {
        const Neighbour found = tree.nearest(query);
        ASSERT_GE(found.index, 0);
        const double nearest = std::sqrt(all_by_distance(points, query)[0].squared_distance);
        const double distance = (points.row(found.index).transpose() - query).norm();
        const double rounding = 1e-15 * (query.norm() + points.cwiseAbs().maxCoeff());
        EXPECT_NEAR(distance, nearest, rounding);
        EXPECT_NEAR(std::sqrt(found.squared_distance), nearest, rounding);
      }
    }
}

TEST(PointTree, FindsTheKNearestOfEveryCloud) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const Points& points : clouds(seed)) {
      const PointTree tree(points);
      RandomCloud random(seed);
      std::vector<Neighbour> found;
      for (const Vector3& query : queries(points, random))
        for (const Index k : {1, 2, 10, 64, 1000}) {
          tree.nearest(query, k, found);
          ASSERT_EQ(static_cast<Index>(found.size()), std::min(k, points.rows()));
          EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
          const std::vector<Neighbour> all = all_by_distance(points, query);
          const double rounding = 1e-15 * (query.norm() + points.cwiseAbs().maxCoeff());
          for (std::size_t i = 0; i < found.size(); ++i)
            ASSERT_NEAR(std::sqrt(found[i].squared_distance), std::sqrt(all[i].squared_distance),
                        rounding);
        }
    }
}

TEST(PointTree, BreaksTiesByTheLowestIndex) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Points points = random.lattice(2000, 6);
    const PointTree tree(points);
    std::vector<Neighbour> found;
    for (const Points& at : {random.lattice(40, 6), Points(random.lattice(40, 12) / 2)})
      for (Index q = 0; q < at.rows(); ++q) {
        const Vector3 query = at.row(q);
        const std::vector<Neighbour> all = all_by_distance(points, query);
        EXPECT_EQ(tree.nearest(query).index, all[0].index);
        tree.nearest(query, 50, found);
        for (std::size_t i = 0; i < found.size(); ++i) ASSERT_EQ(found[i].index, all[i].index);
      }
  }
}

TEST(PointTree, FindsNothingThatIsNotFinite) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  RandomCloud random(0);
  const Points finite = random.box(200);
  Points points = finite;
  for (Index i = 0; i < points.rows(); i += 3) points(i, i % 2) = i % 2 ? nan : infinity;
  const PointTree tree(points);
  std::vector<Neighbour> found;
  for (Index i = 0; i < points.rows(); ++i) {
    const Index nearest = tree.nearest(finite.row(i)).index;
    EXPECT_TRUE(points.row(nearest).allFinite());
    if (points.row(i).allFinite()) {
      EXPECT_EQ(nearest, i);
    }
  }
  tree.nearest(finite.row(0), points.rows(), found);
  EXPECT_EQ(found.size(), 133u);
  EXPECT_EQ(tree.nearest({0, nan, 0}).index, -1);
  EXPECT_EQ(tree.nearest({0, infinity, 0}).index, -1);
  EXPECT_EQ(PointTree(Points(Points::Constant(5, 3, nan))).nearest({0, 0, 0}).index, -1);
}

TEST(PointTree, VisitsAllWithinARadiusAndNoOther) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Points points = random.lattice(1500, 7);
    const PointTree tree(points);
    const Points at = random.lattice(20, 7);
    for (const double radius : {0.0, 0.5, 1.0, 2.0, 3.5, 100.0})
      for (Index q = 0; q < at.rows(); ++q) {
        const Vector3 query = at.row(q);
        std::vector<Neighbour> visited;
        tree.within(query, radius, [&](Index i, double squared) {
          visited.push_back({i, squared});
        });
        std::sort(visited.begin(), visited.end());
        std::vector<Neighbour> expected = all_by_distance(points, query);
        std::erase_if(expected,
                      [&](const Neighbour& n) { return n.squared_distance > radius * radius; });
        ASSERT_EQ(visited.size(), expected.size());
        for (std::size_t i = 0; i < visited.size(); ++i) {
          EXPECT_EQ(visited[i].index, expected[i].index);
          EXPECT_EQ(visited[i].squared_distance, expected[i].squared_distance);
        }
      }
  }
}

// Eight together, in single precision first; far off the cloud and of ties one by one.
TEST(PointTree, FindsTheSameOfManyQueriesAsOfEach) {
  const auto expect_same = [](const Points& points, std::vector<Vector3> queries) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    queries.emplace_back(nan, 0, 0);
    queries.emplace_back(0, infinity, 0);
    queries.emplace_back(1e40, 0, -1e40);
    const PointTree tree(points);
    const double size = points.cwiseAbs().maxCoeff();
    for (const double limit : {infinity, 0.01 * size * size, 0.0}) {
      const std::vector<Neighbour> found = tree.nearest(queries, limit);
      ASSERT_EQ(found.size(), queries.size());
      for (std::size_t q = 0; q < queries.size(); ++q) {
        const Neighbour alone = tree.nearest(queries[q], limit);
        EXPECT_EQ(found[q].index, alone.index);
        EXPECT_EQ(found[q].squared_distance, alone.squared_distance);
      }
    }
  };
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    for (const Points& points : clouds(seed)) expect_same(points, queries(points, random));
    const Points lattice = random.lattice(2000, 6), halves = random.lattice(100, 12) / 2;
    std::vector<Vector3> at;
    for (Index q = 0; q < halves.rows(); ++q) at.emplace_back(halves.row(q).transpose());
    for (const double unit : {1.0, 1e-40, 1e40}) {
      std::vector<Vector3> scaled;
      for (const Vector3& query : at) scaled.push_back(unit * query);
      expect_same(unit * lattice, scaled);
    }
  }
}

TEST(PointTree, TakesTheLimitAsInclusive) {
  Points points(2, 3);
  points << 0, 0, 0, 4, 0, 0;
  const PointTree tree(points);
  EXPECT_EQ(tree.nearest({1, 0, 0}, 1).index, 0);
  EXPECT_EQ(tree.nearest({1, 0, 0}, 0.999).index, -1);
  EXPECT_EQ(tree.nearest({4, 0, 0}, 0).index, 1);
}

TEST(PointTree, OrdersEveryPointOnce) {
  for (const Points& points : clouds(0)) {
    const PointTree tree(points);
    std::vector<std::int32_t> order = tree.order(), all(points.rows());
    std::sort(order.begin(), order.end());
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(order, all);
  }
}

}  // namespace
}  // namespace symsurf::point_tree_tests
