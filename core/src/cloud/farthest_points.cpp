#include "cloud/farthest_points.h"

#include <algorithm>

namespace symsurf {

std::vector<Index> farthest_points(PointsView points, Index count, const Context& context) {
  const auto columns = points.matrix().transpose();
  Eigen::VectorXd distances =
      (columns.colwise() - columns.rowwise().mean()).colwise().squaredNorm();
  std::vector<Index> chosen;
  while (static_cast<Index>(chosen.size()) < std::min(count, points.size())) {
    context.check();
    Index farthest;
    distances.maxCoeff(&farthest);
    const Eigen::VectorXd from =
        (columns.colwise() - columns.col(farthest)).colwise().squaredNorm();
    distances = chosen.empty() ? from : Eigen::VectorXd(distances.cwiseMin(from));
    chosen.push_back(farthest);
  }
  return chosen;
}

}  // namespace symsurf
