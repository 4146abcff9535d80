#include "cloud/farthest_points.h"

#include <algorithm>

namespace symsurf {

std::vector<Index> farthest_points(PointsView points, Index count, const Context& context) {
  const auto squared_distances = [&](const Vector3& from) {
    Eigen::VectorXd squares(points.size());
    for (Index i = 0; i < points.size(); ++i) squares[i] = (points[i] - from).squaredNorm();
    return squares;
  };
  Eigen::VectorXd distances = squared_distances(points.matrix().colwise().mean().transpose());
  std::vector<Index> chosen;
  while (static_cast<Index>(chosen.size()) < std::min(count, points.size())) {
    context.check();
    Index farthest;
    distances.maxCoeff(&farthest);
    const Eigen::VectorXd from = squared_distances(points[farthest]);
    distances = chosen.empty() ? from : Eigen::VectorXd(distances.cwiseMin(from));
    chosen.push_back(farthest);
  }
  return chosen;
}

}  // namespace symsurf
