#include "point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "random_cloud.h"

namespace symsurf {
namespace {

std::vector<Neighbour> all_by_distance(const Points& points, const Vector3& query) {
  std::vector<Neighbour> all;
  for (Index i = 0; i < points.rows(); ++i)
    all.push_back({i, (points.row(i).transpose() - query).squaredNorm()});
  std::sort(all.begin(), all.end());
  return all;
}

Points with_outlier(Points points, double distance) {
  points.row(points.rows() / 2) << distance, -distance, distance / 3;
  return points;
}

Points flattened(Points points, const Vector3& scale) { return points * scale.asDiagonal(); }

// Clouds that are hard on grids, boxes and tie-breaking.
std::vector<Points> clouds(std::uint64_t seed) {
  RandomCloud random(seed);
  const Points box = random.box(700);
  return {box,
          random.sphere(513),
          flattened(box, {1, 1, 0}),
          flattened(box, {1, 0, 0}),
          flattened(box, {0, 0, 0}),
          with_outlier(box, 1e3),
          with_outlier(box, 1e9),
          box.topRows(1),
          box.topRows(9),
          (box.array() + 4e6).matrix(),
          box * 1e-9,
          random.lattice(700, 4)};
}

std::vector<Vector3> queries(const Points& points, RandomCloud& random) {
  std::vector<Vector3> queries;
  const double size = 1 + points.cwiseAbs().maxCoeff();
  for (int i = 0; i < 30; ++i) {
    queries.push_back(points.row(i * 17 % points.rows()));
    queries.push_back(queries.back() + random.in_box() * 0.1);
    queries.push_back(random.in_box() * size);
    queries.push_back(random.in_box() * size * 1e3);
  }
  return queries;
}

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
