#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "cloud/triangulation.h"
#include "mesh_area.h"
#include "random_cloud.h"

namespace symsurf::strip_between_tests {
namespace {

// Two chains over x from 0 to 1, one apart, with points of their own.
struct Chains {
  Chains(std::uint64_t seed, Index count) : points(2 * count, 3), left(count), right(count) {
    RandomCloud random(seed);
    std::vector<double> x(2 * count);
    for (double& each : x) each = random.uniform(0, 1);
    std::sort(x.begin(), x.begin() + count);
    std::sort(x.begin() + count, x.end());
    x.front() = x[count] = 0;
    x[count - 1] = x.back() = 1;
    for (Index i = 0; i < 2 * count; ++i) points.row(i) << x[i], i < count ? 0 : 1, 0;
    std::iota(left.begin(), left.end(), 0);
    std::iota(right.begin(), right.end(), count);
  }
  Points points;
  std::vector<Index> left, right;
};

void expect_strip(const Chains& chains) {
  const Triangles strip = strip_between(chains.points, chains.left, chains.right);
  const Index count = static_cast<Index>(chains.left.size());
  ASSERT_EQ(strip.rows(), 2 * count - 2);
  EXPECT_NEAR(area(Mesh{chains.points, strip}), 1, 1e-9);
  // Neighbours of random points are seldom ten spacings apart.
  const double wide = 20.0 / static_cast<double>(count);
  for (const auto& corner : strip.rowwise())
    for (int c = 0; c < 3; ++c)
      ASSERT_LT(std::abs(chains.points(corner[c], 0) - chains.points(corner[(c + 1) % 3], 0)),
                wide);
}

TEST(StripBetween, FillsTheSpaceBetweenChains) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) expect_strip(Chains(seed, 300));
}

// Too many to compare all strips.
TEST(StripBetween, TakesChainsOfAnyLength) { expect_strip(Chains(0, 40000)); }

}  // namespace
}  // namespace symsurf::strip_between_tests
