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

Points footprint_of(const Cloud& cloud) {
  const PointsView points = cloud.footprint.empty() ? cloud.points : cloud.footprint;
  constexpr Index enough = 2000;
  const Index stride = std::max<Index>(1, points.size() / enough);
  std::vector<Vector3> chosen;
  for (Index i = 0; i < points.size(); i += stride) chosen.push_back(points[i]);
  const std::vector<Vector3> extremes = extreme_points(points);
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
