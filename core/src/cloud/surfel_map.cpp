#include "cloud/surfel_map.h"

#include <limits>

namespace symsurf {

namespace {

constexpr int steps = 2;            // how far a surfel reaches, in cells of the map
constexpr double refinement = 1.5;  // cells of the map along a cell of the surfels

}  // namespace

SurfelMap::SurfelMap(const Surfels& surfels) : cells_(refinement / surfels.spacing()) {
  const double cell = 1 / cells_;
  origin_ = Vector3::Constant(std::numeric_limits<double>::infinity());
  Vector3 high = -origin_;
  for (Index i = 0; i < surfels.size(); ++i) {
    origin_ = origin_.cwiseMin(surfels[i].position);
    high = high.cwiseMax(surfels[i].position);
  }
  origin_.array() -= steps * cell;
  size_ = ((high - origin_) * cells_).cast<int>().array() + steps + 1;
  end_ = size_.cast<double>();
  near_.assign(size_.cast<Index>().prod(), -1);

  const double reach = steps * cell;
  std::vector<float> distance(near_.size(), static_cast<float>(reach * reach));
  for (Index i = 0; i < surfels.size(); ++i) {
    const Vector3& x = surfels[i].position;
    const Eigen::Vector3i centre = ((x - origin_) * cells_).cast<int>();
    const Eigen::Vector3i from = (centre.array() - steps).max(0);
    const Eigen::Vector3i to = (centre.array() + steps).min(size_.array() - 1);
    for (int cx = from.x(); cx <= to.x(); ++cx)
      for (int cy = from.y(); cy <= to.y(); ++cy) {
        const double dx = origin_.x() + (cx + 0.5) * cell - x.x();
        const double dy = origin_.y() + (cy + 0.5) * cell - x.y();
        if (dx * dx + dy * dy >= reach * reach) continue;
        const Index row = linear({cx, cy, 0});
        for (int cz = from.z(); cz <= to.z(); ++cz) {
          const double dz = origin_.z() + (cz + 0.5) * cell - x.z();
          const float squared = static_cast<float>(dx * dx + dy * dy + dz * dz);
          if (squared >= distance[row + cz]) continue;
          distance[row + cz] = squared;
          near_[row + cz] = static_cast<std::int32_t>(i);
        }
      }
  }
}

}  // namespace symsurf
