#include "unit.h"

#include <cstdint>
#include <ctime>
#include <nanoflann.hpp>

namespace symsurf::benchmarks {

namespace {

struct Adaptor {
  PointsView points;

  std::size_t kdtree_get_point_count() const { return static_cast<std::size_t>(points.size()); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points.data()[3 * i + axis];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Adaptor>,
                                                 Adaptor, 3, std::uint32_t>;

}  // namespace

double unit_seconds(PointsView points) {
  const auto matrix = points.matrix();
  const Eigen::RowVector3d extent = matrix.colwise().maxCoeff() - matrix.colwise().minCoeff();
  const Vector3 shift = extent.transpose() / 100;

  const std::clock_t start = std::clock();
  const Adaptor adaptor{points};
  Tree tree(3, adaptor);
  double sum = 0;
  for (Index i = 0; i < points.size(); ++i) {
    const Vector3 query = points[i] + shift;
    std::uint32_t index = 0;
    double squared = 0;
    tree.knnSearch(query.data(), 1, &index, &squared);
    sum += squared;
  }
  const volatile double kept = sum;  // or there would be nothing to do
  static_cast<void>(kept);
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

}  // namespace symsurf::benchmarks
