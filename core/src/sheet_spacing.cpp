#include "sheet_spacing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace symsurf {

double sheet_spacing(PointsView points, const PointTree& tree, Index copies) {
  constexpr Index sixth = 6, samples = 2000;
  const Index neighbours = std::min(copies * (sixth + 1), points.size());
  const Index step = std::max<Index>(1, points.size() / samples);
  std::vector<double> radii;
  std::vector<Neighbour> found;
  for (Index i = 0; i < points.size(); i += step) {
    tree.nearest(points[i], neighbours, found);
    radii.push_back(std::sqrt(found.back().squared_distance));
  }
  const auto median = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), median, radii.end());
  return *median / std::sqrt(static_cast<double>(sixth) / std::numbers::pi);
}

}  // namespace symsurf
