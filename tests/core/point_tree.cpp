#include "spatial/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <vector>

#include "hard_clouds.h"
#include "random_cloud.h"

namespace symsurf {
namespace {

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

TEST(PointTree, AnswersBlocksOfQueriesAsItAnswersEach) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    for (const Points& points : {random.lattice(2000, 6), random.box(2000), random.sphere(500)}) {
      const PointTree tree(points);
      for (const Index k : {1, 10, 40, 100}) {
        std::array<std::vector<Neighbour>, PointTree::block> found;
        std::vector<Neighbour> expected;
        double reach = std::numeric_limits<double>::infinity();
        for (Index p = 0; p + PointTree::block <= tree.size(); p += PointTree::block) {
          PointTree::Queries queries;
          for (Index q = 0; q < PointTree::block; ++q)
            queries.col(q) = points.row(tree.order()[p + q]).transpose();
          tree.nearest(queries, k, p, reach, found);
          for (Index q = 0; q < PointTree::block; ++q) {
            tree.nearest(queries.col(q), k, expected);
            ASSERT_EQ(found[q].size(), expected.size());
            for (std::size_t i = 0; i < expected.size(); ++i) {
              ASSERT_EQ(found[q][i].index, expected[i].index);
              ASSERT_EQ(found[q][i].squared_distance, expected[i].squared_distance);
            }
          }
        }
      }
    }
  }
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
}  // namespace symsurf
