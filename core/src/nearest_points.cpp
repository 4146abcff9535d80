#include "nearest_points.h"

#include <algorithm>
#include <limits>

#include "gathered.h"

namespace symsurf {

namespace {

constexpr std::size_t grain = 64;  // queries between two looks at the clock
constexpr double infinity = std::numeric_limits<double>::infinity();
const Vector3 none = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());

}  // namespace

NearestPoints::NearestPoints(PointsView points, const PointTree& tree, const Context& context)
    : own_(points), tree_(tree), grid_(PointGrid::where_faster(points)), context_(context) {}

NearestPoints::NearestPoints(const Slabs& slabs, const PointTree& tree, const Context& context)
    : NearestPoints(slabs.points(), tree, context) {
  slabs_ = &slabs;
}

NearestPoints::Found NearestPoints::found(const Neighbour& neighbour) const {
  if (neighbour.index < 0) return {none, infinity};
  return {own_[neighbour.index], neighbour.squared_distance};
}

bool NearestPoints::may_be_here(const Vector3& query, double reach) const {
  const Communicator* processes = context_.communicator();
  return !processes || slabs_->distance(query, processes->rank()) <= reach;
}

std::vector<Vector3> NearestPoints::nearest(const std::vector<Vector3>& queries,
                                            double reach) const {
  const double limit = reach * reach;
  std::vector<Found> best;
  best.reserve(queries.size());
  for (const Vector3& query : queries) {
    if (best.size() % grain == 0) context_.check();
    best.push_back(!may_be_here(query, reach) ? Found{none, infinity}
                   : grid_                    ? found(grid_->nearest(query, limit))
                                              : found(tree_.nearest(query, limit)));
  }
  if (context_.communicator()) {
    const auto all = gathered(context_, best);
    best = all.front();
    for (const std::vector<Found>& other : all)
      for (std::size_t q = 0; q < best.size(); ++q)
        if (other[q].squared < best[q].squared) best[q] = other[q];
  }
  std::vector<Vector3> points;
  points.reserve(best.size());
  for (const Found& one : best) points.push_back(one.point);
  return points;
}

std::vector<Vector3> NearestPoints::second_nearest(const std::vector<Vector3>& queries) const {
  std::vector<Found> own;
  std::vector<Neighbour> neighbours;
  for (const Vector3& query : queries) {
    if (own.size() % (2 * grain) == 0) context_.check();
    if (grid_) {
      for (const Neighbour& neighbour : grid_->two_nearest(query)) own.push_back(found(neighbour));
    } else {
      tree_.nearest(query, 2, neighbours);
      neighbours.resize(2);
      for (const Neighbour& neighbour : neighbours) own.push_back(found(neighbour));
    }
  }
  const auto all = gathered(context_, own);
  std::vector<Vector3> points;
  std::vector<Found> candidates;
  for (std::size_t q = 0; q < queries.size(); ++q) {
    candidates.clear();
    for (const std::vector<Found>& part : all)
      for (std::size_t k = 0; k < 2; ++k)
        if (part[2 * q + k].squared < infinity) candidates.push_back(part[2 * q + k]);
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Found& a, const Found& b) { return a.squared < b.squared; });
    points.push_back(candidates[std::min<std::size_t>(1, candidates.size() - 1)].point);
  }
  return points;
}

}  // namespace symsurf
