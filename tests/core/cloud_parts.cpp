#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "cloud/surfels.h"
#include "random_cloud.h"

namespace symsurf::cloud_parts_tests {
namespace {

TEST(CloudParts, AreMadeOnceAndSharedByCopies) {
  const Points points = RandomCloud(0).box(3000);
  const Cloud cloud = checked_cloud(points, {}, 4, {}), copy = cloud;
  EXPECT_EQ(&cloud.tree({}), &copy.tree({}));
  EXPECT_EQ(&cloud.patches(100, {}), &copy.patches(100, {}));
  EXPECT_NE(&cloud.patches(100, {}), &cloud.patches(200, {}));
  EXPECT_EQ(&cloud.finer_patches(100, {}), &copy.finer_patches(100, {}));
  EXPECT_EQ(&cloud.thinned(500, {}), &copy.thinned(500, {}));
}

TEST(CloudParts, AreThoseOfThePoints) {
  const Points points = RandomCloud(1).box(300), others = RandomCloud(2).box(200);
  const Cloud cloud = checked_cloud(points, {}, 4, {});
  Cloud other = cloud;
  EXPECT_EQ(other.tree({}).size(), 300);
  other.set_points(others, {});
  EXPECT_EQ(other.tree({}).size(), 200);
  EXPECT_EQ(cloud.tree({}).size(), 300);
}

TEST(CloudParts, AreMadeOnceWhereThreadsAskAtATime) {
  for (int round = 0; round < 20; ++round) {
    const Points points = RandomCloud(3).box(2000);
    const Cloud cloud = checked_cloud(points, {}, 4, {});
    std::vector<const PointTree*> trees(8);
    std::vector<const Surfels*> patches(trees.size());
    std::vector<std::thread> threads;
    for (std::size_t k = 0; k < trees.size(); ++k)
      threads.emplace_back([&, k] {
        trees[k] = &cloud.tree(Context(nullptr, 1));
        patches[k] = &cloud.finer_patches(100, Context(nullptr, 1));
      });
    for (std::thread& thread : threads) thread.join();
    for (std::size_t k = 0; k < trees.size(); ++k) {
      EXPECT_EQ(trees[k], trees[0]);
      EXPECT_EQ(patches[k], patches[0]);
    }
  }
}

// The planes x = 0, y = 0 and z = 0 map the points that are left of a symmetric set onto each
// other.
TEST(CloudParts, ThinnedKeepsExactPartnersTogether) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    Points points = Eigen::RowVector3d(3, 2, 1).replicate(4000, 1).cwiseProduct(random.box(4000));
    points.bottomRows(2000) = points.topRows(2000);
    points.col(0).tail(2000) *= -1;
    const Cloud cloud = checked_cloud(points, {}, 4, {});
    const Cloud& thinned = cloud.thinned(1000, {});
    EXPECT_NEAR(static_cast<double>(thinned.points.size()), 1000, 2) << seed;
    Index partnered = 0;
    for (Index i = 0; i < thinned.points.size(); ++i) {
      const Vector3 image = thinned.points[i].cwiseProduct(Vector3(-1, 1, 1));
      partnered += thinned.tree({}).nearest(image, 1e-20).index >= 0;
    }
    // To rounding, by which some images fall into another of the cells that are drawn.
    EXPECT_GT(partnered, 0.99 * static_cast<double>(thinned.points.size())) << seed;
    EXPECT_EQ(&cloud.thinned(4000, {}), &cloud) << seed;
  }
}

}  // namespace
}  // namespace symsurf::cloud_parts_tests
