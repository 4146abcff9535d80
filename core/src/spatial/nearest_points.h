#pragma once

#include <symsurf/context.h>
#include <symsurf/points_view.h>

#include <array>
#include <vector>

#include "spatial/point_tree.h"
#include "spatial/slabs.h"

namespace symsurf {

/// Nearest points of the cloud, whichever process holds them. Collective: all processes ask the
/// same.
class NearestPoints {
 public:
  /// Of a process that has all points. The tree is that of the points.
  NearestPoints(PointsView points, const PointTree& tree, const Context& context);

  /// Of processes that each have a slab. The tree is that of this one's.
  NearestPoints(const Slabs& slabs, const PointTree& tree, const Context& context);

  /// The nearest point to each query, NaN where none is within `reach`.
  std::vector<Vector3> nearest(const std::vector<Vector3>& queries, double reach) const;

  /// The nearest but one, copies of the nearest left out; of a single place, that one.
  std::vector<Vector3> second_nearest(const std::vector<Vector3>& queries) const;

 private:
  struct Found {
    Vector3 point;
    double squared;
  };
  using Two = std::array<Found, 2>;  // in two places, the nearest first
  static const Found nothing;

  static Two nearer_two(Two a, Two b);
  Found found(const Neighbour& neighbour) const;
  Two two_nearest(const Vector3& query) const;
  bool may_be_here(const Vector3& query, double reach) const;

  PointsView own_;
  const PointTree& tree_;
  const Slabs* slabs_ = nullptr;
  const Context context_;
};

}  // namespace symsurf
