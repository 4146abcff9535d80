#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <array>
#include <vector>

#include "distributed/slabs.h"
#include "spatial/point_tree.h"

namespace symsurf {

/// Nearest neighbours in a point set that may be distributed. Collective: the queries are the same
/// on all processes.
class NearestPoints {
 public:
  /// Of all points in this process. The tree is that of the points.
  NearestPoints(PointsView points, const PointTree& tree, const Context& context);

  /// Of the points of all slabs. The tree is that of this process's.
  NearestPoints(const Slabs& slabs, const PointTree& tree, const Context& context);

  /// The nearest point to each query, NaN where none is within `reach`.
  std::vector<Vector3> nearest(const std::vector<Vector3>& queries, double reach) const;

  /// The nearest but one, copies of the nearest left out; of a single position, that one.
  std::vector<Vector3> second_nearest(const std::vector<Vector3>& queries) const;

 private:
  struct Found {
    Vector3 point;
    double squared;
  };
  using Two = std::array<Found, 2>;  // in two positions, the nearest first
  static const Found nothing;

  static Two nearer_two(Two a, Two b);
  Found found(const Neighbour& neighbour) const;
  Two two_nearest(const Vector3& query) const;
  bool may_be_here(const Vector3& query, double reach) const;

  PointsView own_;
  const PointTree& tree_;
  const Slabs* slabs_ = nullptr;
  Partition partition_;
  const Context context_;
};

}  // namespace symsurf
