#pragma once

#include <symsurf/points_view.h>

#include <cstdint>
#include <vector>

#include "../point_tree.h"
#include "distance_bound.h"

namespace symsurf {

/// A cloud divided by a plane through its centroid. X1 is the strictly positive side, X2 the rest;
/// each point of X1 has as its partner the point of X2 nearest to its line along the normal (equal
/// distances: the lowest index).
struct Separation {
  Vector3 normal;
  std::vector<std::int32_t> upper;    ///< X1
  std::vector<std::int32_t> partner;  ///< of each, in X2
  std::vector<double> squared;        ///< the partner's squared distance from the line
  std::vector<char> is_upper;         ///< by index of the point
  Index lower = 0;                    ///< size of X2
};

/// Steps 3 to 9 of the thesis's Algorithms 1 and 2 for any number of planes, n log n each: nearest
/// to a line along v is nearest in the projection along v.
class Separator {
 public:
  /// `context` is asked on any thread whether to go on.
  Separator(PointsView points, const PointTree& tree, const Context& context);

  /// Without partners where one side is empty.
  Separation operator()(const Vector3& normal) const;

  /// The shortest distance from any point to any midpoint (step 11).
  double clearance(const Separation& separation) const;

 private:
  PointsView points_;
  const PointTree& tree_;
  const Context context_;
  DistanceBound distance_bound_;
  Vector3 centroid_;
};

}  // namespace symsurf
