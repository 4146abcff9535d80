#include "spatial/nearest_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/math.h"

namespace symsurf {

namespace {

constexpr std::size_t grain = 64;  // queries between two looks at the clock
const Vector3 none = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());

}  // namespace

const NearestPoints::Found NearestPoints::nothing{none, infinity};

NearestPoints::NearestPoints(PointsView points, const PointTree& tree, const Context& context)
    : own_(points), tree_(tree), context_(context) {}

NearestPoints::NearestPoints(const Slabs& slabs, const PointTree& tree, const Context& context)
    : NearestPoints(slabs.points(), tree, context) {
  slabs_ = &slabs;
  partition_ = slabs.partition();
}

NearestPoints::Two NearestPoints::nearer_two(Two a, Two b) {
  if (b[0].squared < a[0].squared) std::swap(a, b);
  const Found& other = b[0].point == a[0].point ? b[1] : b[0];
  if (other.squared < a[1].squared) a[1] = other;
  return a;
}

NearestPoints::Found NearestPoints::found(const Neighbour& neighbour) const {
  if (neighbour.index < 0) return nothing;
  return {own_[neighbour.index], neighbour.squared_distance};
}

bool NearestPoints::may_be_here(const Vector3& query, double reach) const {
  return !slabs_ || slabs_->distance(query) <= reach;
}

std::vector<Vector3> NearestPoints::nearest(const std::vector<Vector3>& queries,
                                            double reach) const {
  const double limit = reach * reach;
  std::vector<Found> best;
  best.reserve(queries.size());
  for (const Vector3& query : queries) {
    if (best.size() % grain == 0) context_.check();
    best.push_back(may_be_here(query, reach) ? found(tree_.nearest(query, limit)) : nothing);
  }
  best = partition_.reduce(std::move(best), [](std::vector<std::vector<Found>> parts) {
    std::vector<Found> nearest = std::move(parts.front());
    for (const std::vector<Found>& part : parts)
      for (std::size_t q = 0; q < part.size(); ++q)
        if (part[q].squared < nearest[q].squared) nearest[q] = part[q];
    return nearest;
  });
  std::vector<Vector3> points;
  points.reserve(best.size());
  for (const Found& one : best) points.push_back(one.point);
  return points;
}

// Duplicates of a point are one position, but several points of the tree: it takes more then.
NearestPoints::Two NearestPoints::two_nearest(const Vector3& query) const {
  constexpr Index most = 64;
  std::vector<Neighbour> near;
  for (Index k = 2;; k *= 4) {
    tree_.nearest(query, k, near);
    const auto other = std::find_if(near.begin(), near.end(), [&](const Neighbour& neighbour) {
      return own_[neighbour.index] != own_[near.front().index];
    });
    if (other != near.end()) return {found(near.front()), found(*other)};
    if (k >= most || static_cast<Index>(near.size()) < k)
      return {near.empty() ? nothing : found(near.front()), nothing};
  }
}

std::vector<Vector3> NearestPoints::second_nearest(const std::vector<Vector3>& queries) const {
  std::vector<Two> best(queries.size(), {nothing, nothing});
  // A query's own slab mostly holds both, and bounds how far off others may have nearer ones.
  for (const bool home : {true, false}) {
    std::vector<Two> own(queries.size(), {nothing, nothing});
    for (std::size_t q = 0; q < queries.size(); ++q) {
      if (q % (2 * grain) == 0) context_.check();
      const bool asked = home ? may_be_here(queries[q], 0)
                              : !may_be_here(queries[q], 0) &&
                                    may_be_here(queries[q], std::sqrt(best[q][1].squared));
      if (asked) own[q] = two_nearest(queries[q]);
    }
    for (const std::vector<Two>& part : partition_.gather(own))
      for (std::size_t q = 0; q < queries.size(); ++q) best[q] = nearer_two(best[q], part[q]);
  }
  std::vector<Vector3> points;
  points.reserve(queries.size());
  for (const auto& [first, second] : best)
    points.push_back(second.squared < infinity ? second.point : first.point);
  return points;
}

}  // namespace symsurf
