#include "symmetry_measure.h"

#include <algorithm>
#include <cmath>

namespace symsurf {

namespace {

// phi'(u) / u.
double wendland_slope(double u) {
  const double v = 1 - u;
  return -14 * v * v * v * v * (4 * u + 1);
}

}  // namespace

double wendland(double u) {
  if (u >= 1) return 0;
  const double v = 1 - u;
  return v * v * v * v * v * (8 * u * u + 5 * u + 1);
}

double measure_reach(PointsView points) {
  const Eigen::RowVector3d centroid = points.matrix().colwise().mean();
  const double average = (points.matrix().rowwise() - centroid).rowwise().norm().mean();
  return 2.6 * average / 15;
}

NearbyPoints::NearbyPoints(PointsView points, double reach) {
  const Vector3 low = points.matrix().colwise().minCoeff();
  const Vector3 high = points.matrix().colwise().maxCoeff();
  constexpr double most_voxels = 1 << 20;  // where an outlier spreads the grid, they grow
  const double volume = ((high - low).array() + reach).prod();
  grid_ = VoxelGrid(low.array() - reach, high.array() + reach,
                    std::max(reach, std::cbrt(volume / most_voxels)));
  lists_.resize(grid_.size());
  for (Index i = 0; i < points.size(); ++i)
    grid_.for_each_touching(grid_.index(grid_.cell_of(points[i])),
                            [&](Index voxel) { lists_[voxel].push_back(points[i]); });
}

double SymmetryMeasure::operator()(const Eigen::Vector4d& p) const {
  Eigen::Vector4d unused;
  return (*this)(p, unused);
}

double SymmetryMeasure::operator()(const Eigen::Vector4d& p, Eigen::Vector4d& gradient) const {
  const Vector3 n = p.head<3>();
  const double nn = n.squaredNorm();
  double sum = 0;
  gradient.setZero();
  for (Index i = 0; i < points_.rows(); ++i) {
    const Vector3 x = points_.row(i).transpose();
    const double l = n.dot(x) + p[3];
    const Vector3 image = x - 2 * l / nn * n;
    const std::vector<Vector3>* const nearby = nearby_(image);
    if (!nearby) continue;
    Vector3 pull = Vector3::Zero();  // gradient by the image
    for (const Vector3& y : *nearby) {
      const double u = (image - y).norm() / reach_;
      if (u >= 1) continue;
      sum += wendland(u);
      pull += wendland_slope(u) / (reach_ * reach_) * (image - y);
    }
    const double along = n.dot(pull);
    gradient.head<3>() -= 2 / nn * (along * x - 2 * l * along / nn * n + l * pull);
    gradient[3] -= 2 / nn * along;
  }
  return sum;
}

}  // namespace symsurf
