#include "cloud/surfel_map.h"

#include "base/math.h"

namespace symsurf {

SurfelMap::SurfelMap(const Surfels& surfels) {
  constexpr int steps = 2;            // how far a surfel reaches, in voxels
  constexpr double refinement = 1.5;  // voxels along a cell of the surfels
  const double edge = surfels.spacing() / refinement, reach = steps * edge;
  Vector3 low = Vector3::Constant(infinity), high = -low;
  for (Index i = 0; i < surfels.size(); ++i) {
    low = low.cwiseMin(surfels[i].position);
    high = high.cwiseMax(surfels[i].position);
  }
  grid_ = VoxelGrid::from_corner(low.array() - reach, high.array() + reach, edge);
  near_.assign(grid_.size(), -1);
  std::vector<float> distance(near_.size(), static_cast<float>(reach * reach));
  for (Index i = 0; i < surfels.size(); ++i) {
    const Vector3& x = surfels[i].position;
    grid_.for_each_row_around(grid_.cell_of(x), steps, [&](Index begin, Index end) {
      VoxelGrid::Cell cell = grid_.cell(begin);
      for (Index voxel = begin; voxel < end; ++voxel, ++cell.z()) {
        const auto squared = static_cast<float>((grid_.middle(cell) - x).squaredNorm());
        if (squared >= distance[voxel]) continue;
        distance[voxel] = squared;
        near_[voxel] = static_cast<std::int32_t>(i);
      }
    });
  }
}

}  // namespace symsurf
