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

NearestPoints::NearestPoints(const Cloud& cloud, const PointTree& own, const Context& context)
    : cloud_(cloud), own_(own), grid_(PointGrid::where_faster(cloud.points)), context_(context) {}

NearestPoints::Found NearestPoints::found(const Neighbour& neighbour) const {
  if (neighbour.index < 0) return {none, infinity};
  return {cloud_.points[neighbour.index], neighbour.squared_distance};
}

std::vector<Vector3> NearestPoints::nearest(const std::vector<Vector3>& queries,
                                            double reach) const {
  const double limit = reach * reach;
  std::vector<Found> best;
  best.reserve(queries.size());
  for (const Vector3& query : queries) {
    if (best.size() % grain == 0) context_.check();
    best.push_back(found(grid_ ? grid_->nearest(query, limit) : own_.nearest(query, limit)));
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
      own_.nearest(query, 2, neighbours);
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
