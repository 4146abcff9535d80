#include "line_partners.h"

#include <Eigen/Geometry>
#include <cmath>

#include "../parallel.h"

namespace symsurf {

LinePartners::LinePartners(PointsView points, const std::vector<std::int32_t>& names)
    : points_(points), names_(names) {
  const Vector3 low = points.matrix().colwise().minCoeff(),
                high = points.matrix().colwise().maxCoeff();
  centre_ = (low + high) / 2;
  const double reach = (high - low).norm() / 2;
  if (reach > 0) scale_ = 1 / reach;
}

void LinePartners::project(const std::vector<std::int32_t>& rows, Places& places,
                           const Context& context) const {
  const auto count = static_cast<Index>(rows.size());
  places.resize(count);
  interruptible_for(context, count, [&](Index k) {
    const Vector3 w = points_[rows[k]] - centre_;
    places.u[k] = static_cast<float>(axes_[0].dot(w));
    places.v[k] = static_cast<float>(axes_[1].dot(w));
  });
}

void LinePartners::find(const std::vector<std::int32_t>& queries,
                        const std::vector<std::int32_t>& targets, const Vector3& direction,
                        const Context& context) {
  axes_[0] = scale_ * direction.unitOrthogonal();
  axes_[1] = direction.cross(axes_[0]);
  project(targets, target_places_, context);
  project(queries, query_places_, context);
  strips_.sort(target_places_, targets, context);

  rows_.resize(queries.size());
  squared_.resize(queries.size());
  // The last answer is a good one to begin with: consecutive queries lie close together.
  std::int32_t last = targets.front();
  interruptible_for(context, static_cast<Index>(queries.size()), [&](Index q) {
    const Vector3 x = points_[queries[q]];
    // What counts is the distance from the line itself, not that of rounded projections.
    const auto measured = [&](std::int32_t row) {
      const Vector3 w = points_[row] - x;
      const Vector3& v = direction;
      const double along = w.x() * v.x() + w.y() * v.y() + w.z() * v.z();
      const double dx = w.x() - along * v.x(), dy = w.y() - along * v.y(),
                   dz = w.z() - along * v.z();
      return dx * dx + dy * dy + dz * dz;
    };
    const auto limit_of = [&](double squared) {
      const float distance = static_cast<float>(scale_ * std::sqrt(squared)) + place_rounding;
      return distance * distance;
    };
    std::int32_t best = last;
    double least = measured(best);
    float limit = limit_of(least);
    const auto consider = [&](std::int32_t row) {
      if (row == best) return;
      const double squared = measured(row);
      if (squared > least || (squared == least && names_[row] > names_[best])) return;
      best = row;
      least = squared;
      limit = limit_of(least);
    };
    const float u = query_places_.u[q], v = query_places_.v[q];
    const auto look = [&](Index strip) { return strips_.near(strip, u, v, limit, consider); };
    Index above = strips_.strip(v), below = above - 1;
    while (above < strips_.count() && look(above)) ++above;
    while (below >= 0 && look(below)) --below;
    rows_[q] = last = best;
    squared_[q] = least;
  });
}

}  // namespace symsurf
