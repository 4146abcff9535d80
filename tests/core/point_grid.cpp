#include "spatial/point_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hard_clouds.h"

namespace symsurf {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// check(grid, query, all points by their distance from it)
template <typename Check>
void for_every_query(const Check& check) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const Points& points : clouds(seed)) {
      const PointGrid grid(points);
      RandomCloud random(seed);
      for (const Vector3& query : queries(points, random)) {
        check(grid, query, all_by_distance(points, query));
      }
    }
}

TEST(PointGrid, FindsTheNearestOfEveryCloudTiesByIndex) {
  for_every_query(
      [](const PointGrid& grid, const Vector3& query, const std::vector<Neighbour>& all) {
        const Neighbour nearest = all[0];
        const Neighbour found = grid.nearest(query, infinity);
        EXPECT_EQ(found.index, nearest.index);
        EXPECT_EQ(found.squared_distance, nearest.squared_distance);
      });
}

TEST(PointGrid, FindsNothingBeyondTheLimit) {
  for_every_query(
      [](const PointGrid& grid, const Vector3& query, const std::vector<Neighbour>& all) {
        const Neighbour nearest = all[0];
        EXPECT_EQ(grid.nearest(query, nearest.squared_distance).index, nearest.index);
        const double less = std::nextafter(nearest.squared_distance, -1.0);
        EXPECT_EQ(less < 0 ? -1 : grid.nearest(query, less).index, -1);
      });
}

TEST(PointGrid, FindsTheTwoNearest) {
  for_every_query(
      [](const PointGrid& grid, const Vector3& query, const std::vector<Neighbour>& all) {
        const auto found = grid.two_nearest(query);
        EXPECT_EQ(found[0].index, all[0].index);
        EXPECT_EQ(found[1].index, all.size() > 1 ? all[1].index : -1);
      });
}

TEST(PointGrid, FindsNothingNowhere) {
  RandomCloud random(0);
  const PointGrid grid(random.box(50));
  const Vector3 nowhere(0, std::numeric_limits<double>::quiet_NaN(), 0);
  EXPECT_EQ(grid.nearest(nowhere, infinity).index, -1);
}

}  // namespace
}  // namespace symsurf
