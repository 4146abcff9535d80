#include "cloud/surface_spacing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/math.h"

namespace symsurf {

namespace {

constexpr std::size_t sixth = 6;

double spacing_from(double sixth_distance) {
  return sixth_distance / std::sqrt(static_cast<double>(sixth) / std::numbers::pi);
}

}  // namespace

double spacing_at(const std::vector<Neighbour>& neighbourhood) {
  const std::size_t rank = std::min(sixth, neighbourhood.size() - 1);
  return spacing_from(std::sqrt(neighbourhood[rank].squared_distance));
}

double surface_spacing(PointsView points, const PointTree& tree, Index copies) {
  constexpr Index samples = 2000;
  const Index neighbours = std::min(copies * static_cast<Index>(sixth + 1), points.size());
  const Index step = std::max<Index>(1, points.size() / samples);
  std::vector<double> distances;
  std::vector<Neighbour> found;
  for (Index i = 0; i < points.size(); i += step) {
    tree.nearest(points[i], neighbours, found);
    distances.push_back(std::sqrt(found.back().squared_distance));
  }
  return spacing_from(median(std::move(distances)));
}

}  // namespace symsurf
