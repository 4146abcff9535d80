#pragma once

#include <utility>

#include "cloud/surfels.h"
#include "spatial/point_tree.h"

namespace symsurf {

/// One of two halves of a cloud, as one mean a cell: its density does not show.
struct ThinnedHalf {
  explicit ThinnedHalf(Points means) : points(std::move(means)), tree(points) {}
  Points points;  ///< in the principal frame
  PointTree tree;
};

/// A cloud split at random into halves. How well one says what the other says is the most that a
/// mirror image can. Copies of a point are one point, clutter is left out. The same on all
/// processes; collective.
struct CloudHalves {
  /// `surface`: what lies in none of its cells is clutter. `split`: which of several.
  CloudHalves(const Cloud& cloud, const Surfels& surface, std::size_t split);

  double cell;           ///< its edge, as wide as the sparse parts of the cloud need
  ThinnedHalf one, two;  ///< on grids that are turned against each other

 private:
  struct Split;
  explicit CloudHalves(const Split& split);
};

}  // namespace symsurf
