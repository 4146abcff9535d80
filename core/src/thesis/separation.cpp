#include "separation.h"

#include <cmath>
#include <utility>

#include "projection.h"

namespace symsurf {

Separator::Separator(PointsView points, const PointTree& tree, const Context& context)
    : points_(points),
      tree_(tree),
      context_(context),
      distance_bound_(points, context),
      centroid_(Vector3::Zero()) {
  for (Index i = 0; i < points.size(); ++i) centroid_ += points[i];
  centroid_ /= static_cast<double>(points.size());
}

Separation Separator::operator()(const Vector3& normal) const {
  Separation result;
  result.normal = normal;
  result.is_upper.resize(points_.size());
  std::vector<std::int32_t> lower;
  for (const std::int32_t i : tree_.order()) {
    const bool is_upper = (points_[i] - centroid_).dot(normal) > 0;
    result.is_upper[i] = is_upper;
    (is_upper ? result.upper : lower).push_back(i);
  }
  result.lower = static_cast<Index>(lower.size());
  if (result.upper.empty() || lower.empty()) return result;

  LinePartners partners = nearest_to_lines(points_, result.upper, lower, normal, context_);
  result.partner = std::move(partners.target);
  result.squared = std::move(partners.squared);
  return result;
}

double Separator::clearance(const Separation& separation) const {
  const std::size_t count = separation.upper.size();
  const auto midpoint = [&](std::size_t k) -> Vector3 {
    return (points_[separation.upper[k]] + points_[separation.partner[k]]) / 2;
  };
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < count; ++k)
    shortest = std::min(shortest, (points_[separation.upper[k]] - midpoint(k)).norm());
  // A midpoint needs a search only where neither the grid nor the distance known at an anchor a,
  // less |y - a|, rules it out; and the fewer, the sooner a short distance is known.
  constexpr double rounding = 1e-9;
  constexpr std::size_t ahead = 61;
  Vector3 anchor = Vector3::Zero();
  double known = -1;
  Index near = 0;
  PointTree::Queries waiting;
  int waits = 0;
  const auto search = [&] {
    context_.check();
    const double reach = shortest + std::min(shortest, distance_bound_.cell());
    const auto found = tree_.nearest(waiting, reach * reach, near);
    anchor = waiting.col(waits - 1);
    known = reach;
    for (int i = 0; i < waits; ++i) {
      const double distance = found[i].index < 0 ? reach : std::sqrt(found[i].squared_distance);
      shortest = std::min(shortest, distance);
      if (i == waits - 1) known = distance;
    }
    waits = 0;
  };
  for (const std::size_t stride : {ahead, std::size_t{1}})
    for (std::size_t k = 0; k < count && shortest > 0; k += stride) {
      const Vector3 y = midpoint(k);
      const double settled = shortest * (1 + rounding);
      if (distance_bound_(y) > settled || known - (y - anchor).norm() > settled) continue;
      if (waits == 0) waiting.colwise() = y;
      waiting.col(waits++) = y;
      if (waits == PointTree::block) search();
    }
  if (waits > 0) search();
  return shortest;
}

}  // namespace symsurf
