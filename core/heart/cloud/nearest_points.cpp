#include "cloud/nearest_points.h"

#include <algorithm>
#include <limits>

namespace symsurf {

namespace {

constexpr std::size_t queries_between_checks = 64;  // queries between two looks at the clock
const Vector3 none = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());

}  // namespace

std::vector<Vector3> NearestPoints::nearest(const std::vector<Vector3>& queries,
                                            double reach) const {
  const double limit = reach * reach;
  std::vector<Vector3> nearest;
  nearest.reserve(queries.size());
  for (const Vector3& query : queries) {
    if (nearest.size() % queries_between_checks == 0) context_.check();
    const Index found = tree_.nearest(query, limit).index;
    nearest.push_back(found < 0 ? none : points_[found]);
  }
  return nearest;
}

// Duplicates of a point are one position, but several points of the tree: it takes more then.
Vector3 NearestPoints::second_nearest(const Vector3& query) const {
  constexpr Index most = 64;
  std::vector<Neighbour> near;
  for (Index k = 2;; k *= 4) {
    tree_.nearest(query, k, near);
    if (near.empty()) return none;
    const Vector3 first = points_[near.front().index];
    const auto other = std::find_if(near.begin(), near.end(), [&](const Neighbour& neighbour) {
      return points_[neighbour.index] != first;
    });
    if (other != near.end()) return points_[other->index];
    if (k >= most || static_cast<Index>(near.size()) < k) return first;
  }
}

std::vector<Vector3> NearestPoints::second_nearest(const std::vector<Vector3>& queries) const {
  std::vector<Vector3> second;
  second.reserve(queries.size());
  for (const Vector3& query : queries) {
    if (second.size() % (2 * queries_between_checks) == 0) context_.check();
    second.push_back(second_nearest(query));
  }
  return second;
}

}  // namespace symsurf
