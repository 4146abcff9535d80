#include "cloud/voxel_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "random_cloud.h"

namespace symsurf::voxel_grid_tests {
namespace {

TEST(VoxelGrid, FindsTheVoxelOfEachPositionInTheBox) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Vector3 low = 5 * random.in_box(), size = random.in_box().cwiseAbs();
    const VoxelGrid grid(low, low + size, 0.4);
    for (int k = 0; k < 100; ++k) {
      const Vector3 x = low + size.cwiseProduct(random.in_box().cwiseAbs());
      const VoxelGrid::Cell cell = grid.cell_of(x);
      EXPECT_LE((grid.middle(cell) - x).cwiseAbs().maxCoeff(), 0.2 * (1 + 1e-9)) << seed;
      EXPECT_EQ(grid.index_at(x), grid.index(cell)) << seed;
      EXPECT_EQ(grid.cell(grid.index(cell)), cell) << seed;
    }
    EXPECT_EQ(grid.index_at(low - Vector3::Constant(0.5)), -1);
    EXPECT_EQ(grid.index_at(low + size + Vector3::Constant(0.5)), -1);
  }
}

TEST(VoxelGrid, VisitsTheVoxelsThatTouchOne) {
  const VoxelGrid grid(Vector3::Zero(), {2, 3, 4}, 1);
  for (Index index = 0; index < grid.size(); ++index) {
    std::set<Index> visited, touching;
    grid.for_each_touching(index, [&](Index other) { visited.insert(other); });
    for (Index other = 0; other < grid.size(); ++other)
      if ((grid.cell(other) - grid.cell(index)).cwiseAbs().maxCoeff() <= 1) touching.insert(other);
    EXPECT_EQ(visited, touching) << index;
  }
}

TEST(OccupiedVoxels, AreNumberedInTheirOrder) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const int voxels : {1, 63, 64, 65, 1000}) {
      RandomCloud random(seed);
      const auto draw = [&] {
        return std::min(voxels - 1, static_cast<int>(random.uniform(0, 1) * voxels));
      };
      const VoxelGrid row(Vector3::Zero(), Vector3(0, 0, voxels - 1), 1);
      ASSERT_EQ(row.size(), voxels);
      OccupiedVoxels occupied(row);
      std::set<int> known{0, voxels - 1};
      for (int k = 0; k < voxels / 3; ++k) {
        const int here = draw(), there = draw();
        occupied.occupy(VoxelGrid::Cell(0, 0, here));
        occupied.occupy(VoxelGrid::Cell(0, 0, there));
        known.insert({here, there});
      }
      occupied.occupy(VoxelGrid::Cell(0, 0, 0));
      occupied.occupy(VoxelGrid::Cell(0, 0, voxels - 1));
      occupied.number_them();

      Index number = 0;
      for (int z = 0; z < voxels; ++z) {
        const VoxelGrid::Cell cell(0, 0, z);
        const Index expected = known.contains(z) ? number++ : -1;
        EXPECT_EQ(occupied.number(cell), expected) << seed << ' ' << z;
        EXPECT_EQ(occupied.number_at(row.middle(cell)), expected) << seed << ' ' << z;
        std::set<Index> visited, touching;
        occupied.for_each_occupied_touching(cell, [&](Index other) { visited.insert(other); });
        for (const int other : {z - 1, z, z + 1})
          if (known.contains(other)) touching.insert(occupied.number({0, 0, other}));
        EXPECT_EQ(visited, touching) << seed << ' ' << z;
      }
      EXPECT_EQ(occupied.count(), number) << seed << ' ' << voxels;
    }
}

}  // namespace
}  // namespace symsurf::voxel_grid_tests
