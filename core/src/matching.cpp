#include "matching.h"

#include <algorithm>
#include <cmath>

#include "parallel.h"

namespace symsurf {

void add_pairs(Result& result, PointsView points, const PointTree& tree, const Mirror& mirror,
               double limit, const Context& context) {
  constexpr Index grain = 4096;
  std::vector<std::int32_t> partner(points.size(), -1);
  parallel_for(context, points.size(), grain, [&](Index begin, Index end) {
    for (Index p = begin; p < end; ++p) {
      const Index i = tree.order()[p];
      const Vector3 image = mirror.reflect(points[i]);
      if (!image.allFinite()) continue;
      partner[i] = static_cast<std::int32_t>(tree.nearest(image, limit * limit).index);
    }
  });

  const Index found = points.size() - std::count(partner.begin(), partner.end(), -1);
  result.pairs.resize(found, 2);
  result.residuals.resize(found);
  result.surface_points.resize(found, 3);
  for (Index i = 0, row = 0; i < points.size(); ++i) {
    if (partner[i] < 0) continue;
    const Vector3 x = points[i], y = points[partner[i]];
    result.pairs.row(row) << i, partner[i];
    result.residuals[row] = (mirror.reflect(x) - y).norm();
    result.surface_points.row(row) = (x + y).transpose() / 2;
    ++row;
  }
}

}  // namespace symsurf
