#include "cloud/footprint.h"

#include <algorithm>
#include <memory>

#include "base/math.h"

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

namespace {

// The lowest and the highest point along each axis: none of no points, else six.
std::vector<Vector3> extreme_points(PointsView points) {
  std::vector<Vector3> extremes;
  for (int axis = 0; axis < 3 && !points.empty(); ++axis) {
    Index low, high;
    points.matrix().col(axis).minCoeff(&low);
    points.matrix().col(axis).maxCoeff(&high);
    extremes.insert(extremes.end(), {points[low], points[high]});
  }
  return extremes;
}

}  // namespace

std::vector<Vector3> extreme_points(PointsView own, const Partition& partition) {
  std::vector<Vector3> extremes;
  for (const std::vector<Vector3>& part : partition.gather(extreme_points(own))) {
    if (extremes.empty()) {
      extremes = part;
      continue;
    }
    for (std::size_t k = 0; k < part.size(); ++k) {
      const int axis = static_cast<int>(k) / 2;
      const double beyond = part[k][axis] - extremes[k][axis];
      if (k % 2 == 0 ? beyond < 0 : beyond > 0) extremes[k] = part[k];
    }
  }
  return extremes;
}

Points footprint_of(const Cloud& cloud) {
  const PointsView own = cloud.footprint.empty() ? cloud.points : cloud.footprint;
  const Partition partition = cloud.partition.resized(own.size());
  constexpr Index enough = 2000;
  const Index stride = std::max<Index>(1, partition.total() / enough);
  std::vector<Vector3> chosen;
  for (Index i = partition.first_of_every(stride); i < own.size(); i += stride)
    chosen.push_back(own[i]);
  chosen = partition.concatenate(chosen);
  const std::vector<Vector3> extremes = extreme_points(own, partition);
  chosen.insert(chosen.end(), extremes.begin(), extremes.end());
  return rows_of(chosen);
}

void set_footprint(Result& result, const Cloud& cloud) {
  if (result.mirror) set_footprint(result, footprint_of(cloud));
}

void set_footprint(Result& result, Points rows) {
  const auto footprint = std::make_shared<const Points>(std::move(rows));
  if (result.mirror) result.mirror->set_footprint(footprint);
  for (Result& candidate : result.candidates)
    if (candidate.mirror) candidate.mirror->set_footprint(footprint);
}

}  // namespace symsurf
