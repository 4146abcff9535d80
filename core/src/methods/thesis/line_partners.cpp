#include "methods/thesis/line_partners.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>

#include "base/parallel.h"
#include "methods/thesis/place_queries.h"

namespace symsurf {

namespace {

constexpr Index block = PlaceQueries::block, stretch = 1 << 11;

// More than the rounding of any distance between places.
constexpr float rounding = 2e-6f;

}  // namespace

LinePartners::LinePartners(PointsView points, const std::vector<std::int32_t>& names)
    : points_(points), names_(names) {
  const Vector3 low = points.matrix().colwise().minCoeff(),
                high = points.matrix().colwise().maxCoeff();
  centre_ = (low + high) / 2;
  const double reach = (high - low).norm() / 2;
  if (reach > 0) scale_ = 1 / reach;
}

void LinePartners::sort(const std::vector<std::int32_t>& queries,
                        const std::vector<std::int32_t>& targets, const Vector3& direction,
                        const Context& context) {
  const Vector3 across = direction.unitOrthogonal();
  const Vector3 e1 = scale_ * across, e2 = scale_ * direction.cross(across);
  const auto count = static_cast<Index>(targets.size());
  places_.resize(count + static_cast<Index>(queries.size()));
  const auto row = [&](Index k) { return k < count ? targets[k] : queries[k - count]; };
  interruptible_for(context, places_.size(), [&](Index k) {
    const Vector3 w = points_[row(k)] - centre_;
    places_.u[k] = static_cast<float>(e1.dot(w));
    places_.v[k] = static_cast<float>(e2.dot(w));
  });
  curve_.sort(places_, context);

  targets_.clear();
  queries_.clear();
  interruptible_for(context, places_.size(), [&](Index c) {
    const std::int32_t k = curve_[c];
    const float u = places_.u[k], v = places_.v[k];
    if (k < count)
      targets_.add(u, v, 0, targets[k]);
    else
      queries_.push_back({u, v, static_cast<std::int32_t>(k - count),
                          std::max(static_cast<std::int32_t>(targets_.runs().size()) - 1, 0)});
  });
  targets_.build(context);
}

void LinePartners::find(const std::vector<std::int32_t>& queries,
                        const std::vector<std::int32_t>& targets, const Vector3& direction,
                        const Context& context) {
  sort(queries, targets, direction, context);
  rows_.resize(queries.size());
  squared_.resize(queries.size());

  struct Best {
    Vector3 x;
    std::int32_t row;
    double squared;
  };
  std::array<Best, block> best;
  const auto consider = [&](int q, std::int32_t row) {
    // What counts is the distance from the line itself, not that of rounded projections.
    const Vector3 w = points_[row] - best[q].x;
    const Vector3& v = direction;
    const double along = w.x() * v.x() + w.y() * v.y() + w.z() * v.z();
    const double dx = w.x() - along * v.x(), dy = w.y() - along * v.y(), dz = w.z() - along * v.z();
    const double squared = dx * dx + dy * dy + dz * dz;
    Best& b = best[q];
    if (squared > b.squared || (squared == b.squared && names_[row] > names_[b.row])) return;
    b.row = row;
    b.squared = squared;
  };
  PlaceQueries queried(rounding, 2);
  PlaceQueries::Places places{};
  const auto count = static_cast<Index>(queries_.size());
  interruptible_for(
      context, (count + block - 1) / block,
      [&](Index b) {
        for (int q = 0; q < block; ++q) {
          const Query& query = queries_[std::min(b * block + q, count - 1)];
          places[0][q] = query.u;
          places[1][q] = query.v;
          best[q] = {points_[queries[query.number]], 0, std::numeric_limits<double>::infinity()};
        }
        queried.begin(places, BlockQueries::anywhere());
        queried.lower_limits(targets_.runs()[queries_[b * block].run]);
        visit_nearest(targets_, queried, consider, any_index);
        for (Index k = b * block; k < std::min((b + 1) * block, count); ++k) {
          rows_[queries_[k].number] = best[k % block].row;
          squared_[queries_[k].number] = best[k % block].squared;
        }
      },
      stretch);
}

}  // namespace symsurf
