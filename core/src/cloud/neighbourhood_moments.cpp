#include "cloud/neighbourhood_moments.h"

#include <cmath>
#include <vector>

#include "base/parallel.h"

namespace symsurf {

namespace {

// `found`: nearest first.
NeighbourhoodMoments moments_of(const Vector3& x, PointsView points,
                                const std::vector<Neighbour>& found) {
  NeighbourhoodMoments around;
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

void visit_neighbourhoods(PointsView points, const PointTree& tree, Index k,
                          const std::vector<Index>& positions, const Context& context,
                          const std::function<void(Index, const NeighbourhoodMoments&)>& visit) {
  constexpr Index grain = 1024;
  parallel_for(context, static_cast<Index>(positions.size()), grain, [&](Index begin, Index end) {
    std::vector<Neighbour> found;
    for (Index v = begin; v < end; ++v) {
      const Vector3 x = points[tree.order()[positions[v]]];
      tree.nearest(x, k + 1, found);  // the point itself is the nearest
      visit(v, moments_of(x, points, found));
    }
  });
}

}  // namespace symsurf
