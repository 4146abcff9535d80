#pragma once

#include <symsurf/points_view.h>

#include <cstdint>
#include <vector>

#include "methods/thesis/close_cells.h"
#include "methods/thesis/distance_bound.h"
#include "methods/thesis/line_partners.h"
#include "spatial/point_tree.h"

namespace symsurf {

/// A cloud divided by a plane through its centroid. X1 is the strictly positive side, X2 the rest;
/// each point of X1 has as its partner the point of X2 nearest to its line along the normal (equal
/// distances: the lowest index).
struct Separation {
  Vector3 normal;
  std::vector<std::int32_t> upper, lower;  ///< X1, X2
  std::vector<std::int32_t> partner;       ///< of each of X1, in X2
  std::vector<Vector3> midpoint;           ///< of each of X1 and its partner
  double half_chord = 0;                   ///< the least distance of a midpoint from its two points
  std::vector<char> is_upper;              ///< by index of the point
  LinePartners partners;

  explicit Separation(const LinePartners& empty) : partners(empty) {}

  /// The partner's squared distance from the line, of each of X1.
  const std::vector<double>& squared() const { return partners.squared(); }
};

/// Steps 3 to 9 of the thesis's Algorithms 1 and 2 for any number of planes, n log n each.
class Separator {
 public:
  /// `context` is asked on any thread whether to go on.
  Separator(PointsView points, const PointTree& tree, const Context& context);
  Separator(const Separator&) = delete;

  /// Room for one separation after the other, on one thread.
  Separation room() const;

  /// Without partners where one side is empty.
  void operator()(const Vector3& normal, Separation& separation) const;

  /// The shortest distance from any point to any midpoint (step 11).
  double clearance(const Separation& separation) const;

 private:
  const PointTree& tree_;
  const Context context_;
  DistanceBound distance_bound_;
  CloseCells close_cells_;
  Points sorted_;          // as the tree has them
  LinePartners partners_;  // of sorted_
  Vector3 centroid_;
};

}  // namespace symsurf
