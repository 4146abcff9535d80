#include "nearest_points.h"

#include <algorithm>
#include <limits>

#include "gathered.h"

namespace symsurf {

namespace {

// In a cloud of no more points images that follow each other lie close together; in a bigger one
// there are many points between them.
constexpr Index small_cloud = 8192;
constexpr double infinity = std::numeric_limits<double>::infinity();
const Vector3 none = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());

}  // namespace

NearestPoints::NearestPoints(const Cloud& cloud, const PointTree& own, const Context& context)
    : cloud_(cloud), own_(own), context_(context) {}

std::vector<NearestPoints::Found> NearestPoints::own_nearest(const std::vector<Vector3>& queries,
                                                             double reach) const {
  constexpr std::size_t block = PointTree::block;
  const double limit = reach * reach;
  std::vector<Found> found(queries.size(), {none, infinity});
  const auto take = [&](std::size_t q, const Neighbour& neighbour) {
    if (neighbour.index >= 0)
      found[q] = {cloud_.points[neighbour.index], neighbour.squared_distance};
  };
  if (own_.size() > small_cloud) {
    for (std::size_t q = 0; q < queries.size(); ++q) take(q, own_.nearest(queries[q], limit));
    return found;
  }
  Index near = 0;
  for (std::size_t begin = 0; begin < queries.size(); begin += block) {
    const std::size_t count = std::min(block, queries.size() - begin);
    PointTree::Queries together;
    together.setConstant(std::numeric_limits<double>::quiet_NaN());
    for (std::size_t k = 0; k < count; ++k)
      together.col(static_cast<Index>(k)) = queries[begin + k];
    const auto neighbours = own_.nearest(together, limit, near);
    for (std::size_t k = 0; k < count; ++k) take(begin + k, neighbours[k]);
  }
  return found;
}

std::vector<Vector3> NearestPoints::nearest(const std::vector<Vector3>& queries,
                                            double reach) const {
  std::vector<Found> best = own_nearest(queries, reach);
  if (context_.communicator()) {
    const auto all = gathered(context_, best);
    best = all.front();
    for (const std::vector<Found>& other : all)
      for (std::size_t q = 0; q < best.size(); ++q)
        if (other[q].squared < best[q].squared) best[q] = other[q];
  }
  std::vector<Vector3> points;
  points.reserve(best.size());
  for (const Found& found : best) points.push_back(found.point);
  return points;
}

std::vector<Vector3> NearestPoints::second_nearest(const std::vector<Vector3>& queries) const {
  std::vector<Found> own;
  std::vector<Neighbour> neighbours;
  for (const Vector3& query : queries) {
    own_.nearest(query, 2, neighbours);
    for (std::size_t k = 0; k < 2; ++k)
      own.push_back(k < neighbours.size()
                        ? Found{cloud_.points[neighbours[k].index], neighbours[k].squared_distance}
                        : Found{none, infinity});
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
