#include "cloud/surroundings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/infinity.h"
#include "base/parallel.h"

namespace symsurf {

namespace {

// `found`: nearest first.
Surroundings surroundings_of(const Vector3& x, PointsView points,
                             const std::vector<Neighbour>& found) {
  Surroundings around;
  const double farthest = found.back().squared_distance;
  if (!(farthest > 0)) return around;
  around.radius = std::sqrt(farthest);
  double weights = 0;
  for (const Neighbour& neighbour : found) {
    const double weight = 1 - neighbour.squared_distance / farthest;
    const Vector3 offset = (points[neighbour.index] - x) / around.radius;
    weights += weight;
    around.mean += weight * offset;
    around.covariance += weight * offset * offset.transpose();
  }
  around.mean /= weights;
  around.covariance = around.covariance / weights - around.mean * around.mean.transpose();
  return around;
}

}  // namespace

void visit_surroundings(PointsView points, const PointTree& tree, Index k,
                        const std::vector<Index>& places, const Context& context,
                        const std::function<void(Index, const Surroundings&)>& visit) {
  constexpr Index grain = 1024;
  parallel_for(context, static_cast<Index>(places.size()), grain, [&](Index begin, Index end) {
    std::array<std::vector<Neighbour>, PointTree::block> found;
    double reach = infinity;
    for (Index v = begin; v < end; v += PointTree::block) {
      const auto at = [&](Index lane) {
        return points[tree.order()[places[std::min(v + lane, end - 1)]]];
      };
      PointTree::Queries queries;
      for (Index lane = 0; lane < PointTree::block; ++lane) queries.col(lane) = at(lane);
      tree.nearest(queries, k + 1, places[v], reach, found);  // the point itself is the nearest
      for (Index lane = 0; lane < PointTree::block && v + lane < end; ++lane)
        visit(v + lane, surroundings_of(at(lane), points, found[lane]));
    }
  });
}

}  // namespace symsurf
