#include "cloud/surface_spacing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/math.h"

namespace symsurf {

double surface_spacing(PointsView points, const PointTree& tree, Index copies) {
  constexpr Index sixth = 6, samples = 2000;
  const Index neighbours = std::min(copies * (sixth + 1), points.size());
  const Index step = std::max<Index>(1, points.size() / samples);
  std::vector<double> radii;
  std::vector<Neighbour> found;
  for (Index i = 0; i < points.size(); i += step) {
    tree.nearest(points[i], neighbours, found);
    radii.push_back(std::sqrt(found.back().squared_distance));
  }
  return median(std::move(radii)) / std::sqrt(static_cast<double>(sixth) / std::numbers::pi);
}

}  // namespace symsurf
