#include "methods/thesis/separation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace symsurf {

namespace {

Points in_order(PointsView points, const std::vector<std::int32_t>& order, const Context& context) {
  Points sorted(points.size(), 3);
  interruptible_for(context, points.size(),
                    [&](Index p) { sorted.row(p) = points[order[p]].transpose(); });
  return sorted;
}

}  // namespace

Separator::Separator(PointsView points, const PointTree& tree, const Context& context)
    : tree_(tree),
      context_(context),
      distance_bound_(points, context),
      close_cells_(points, distance_bound_.cell() / 96, context),
      sorted_(in_order(points, tree.order(), context)),
      partners_(PointsView(sorted_), tree.order()),
      centroid_(Vector3::Zero()) {
  interruptible_for(context, points.size(), [&](Index i) { centroid_ += points[i]; });
  centroid_ /= static_cast<double>(points.size());
}

Separation Separator::room() const { return Separation(partners_); }

void Separator::operator()(const Vector3& normal, Separation& separation) const {
  const PointsView points(sorted_);
  const std::vector<std::int32_t>& names = tree_.order();
  separation.normal = normal;
  separation.is_upper.resize(points.size());
  std::vector<std::int32_t>&upper = separation.upper, &lower = separation.lower;
  upper.clear();
  lower.clear();
  interruptible_for(context_, points.size(), [&](Index p) {
    const bool is_upper = (points[p] - centroid_).dot(normal) > 0;
    separation.is_upper[names[p]] = is_upper;
    (is_upper ? upper : lower).push_back(static_cast<std::int32_t>(p));
  });
  if (upper.empty() || lower.empty()) return;

  separation.partners.find(upper, lower, normal, context_);
  separation.partner = separation.partners.rows();
  separation.midpoint.resize(upper.size());
  separation.half_chord = std::numeric_limits<double>::infinity();
  interruptible_for(context_, static_cast<Index>(upper.size()), [&](Index k) {
    const Vector3 x = points[upper[k]], y = (x + points[separation.partner[k]]) / 2;
    separation.midpoint[k] = y;
    separation.half_chord = std::min(separation.half_chord, (x - y).norm());
  });
  for (std::vector<std::int32_t>* rows : {&upper, &lower, &separation.partner})
    interruptible_for(context_, static_cast<Index>(rows->size()),
                      [&](Index k) { (*rows)[k] = names[(*rows)[k]]; });
}

double Separator::clearance(const Separation& separation) const {
  const std::vector<Vector3>& midpoint = separation.midpoint;
  const auto count = static_cast<Index>(midpoint.size());
  double shortest = separation.half_chord;
  // A midpoint needs a search only where neither the grid nor the distance known at an anchor a,
  // less |y - a|, rules it out; and the fewer, the sooner a short distance is known.
  constexpr double rounding = 1e-9;
  constexpr Index ahead = 61;
  Vector3 anchor = Vector3::Zero();
  double known = -1;
  const double cell = distance_bound_.cell();
  for (const Index stride : {ahead, Index{1}})
    interruptible_for(context_, (count + stride - 1) / stride, [&](Index step) {
      if (shortest == 0) return;
      const Vector3& y = midpoint[step * stride];
      const double settled = shortest * (1 + rounding);
      if (settled < close_cells_.reach() && !close_cells_.may_hold(y)) return;
      if (distance_bound_(y) > settled || known - (y - anchor).norm() > settled) return;
      // What is known a little farther spares the neighbours.
      const double reach = shortest + (shortest > cell ? cell : 0);
      const Neighbour found = tree_.nearest(y, reach * reach);
      anchor = y;
      known = found.index < 0 ? reach : std::sqrt(found.squared_distance);
      shortest = std::min(shortest, known);
    });
  return shortest;
}

}  // namespace symsurf
