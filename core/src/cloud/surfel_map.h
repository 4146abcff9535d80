#pragma once

#include <cstdint>
#include <vector>

#include "cloud/surfels.h"

namespace symsurf {

/// Which surfel lies nearest to any position, to half a cell: one look-up instead of a search.
class SurfelMap {
 public:
  explicit SurfelMap(const Surfels& surfels);

  /// The surfel nearest to x, or -1 when none lies within about a cell and a half of it.
  Index nearest(const Vector3& x) const {
    const Index voxel = grid_.index_at(x);
    return voxel < 0 ? -1 : near_[voxel];
  }

 private:
  VoxelGrid grid_;
  std::vector<std::int32_t> near_;  // by voxel
};

}  // namespace symsurf
