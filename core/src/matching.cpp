#include "matching.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "parallel.h"
#include "point_grid.h"
#include "shared_matching.h"

namespace symsurf {

namespace {

// Writes each point's partner beside it, -1: none.
void find_partners(PointsView points, const PointTree& tree, const Mirror& mirror, double limit,
                   const Context& context, Pairs& pairs) {
  constexpr Index grain = 4096;
  if (points.size() <= PointGrid::small_cloud) {
    const PointGrid grid(points);
    if (grid.fullest() <= PointGrid::crowded) {
      parallel_for(context, points.size(), grain, [&](Index begin, Index end) {
        for (Index i = begin; i < end; ++i)
          pairs(i, 1) = grid.nearest(mirror.reflect(points[i]), limit * limit).index;
      });
      return;
    }
  }
  const std::vector<std::int32_t>& order = tree.order();
  parallel_for(context, static_cast<Index>(order.size()), grain, [&](Index begin, Index end) {
    Index near = begin;
    for (Index p = begin; p < end; p += PointTree::block) {
      const Index last = end - 1;
      PointTree::Queries images;
      for (Index i = 0; i < PointTree::block; ++i)
        images.col(i) = mirror.reflect(points[order[std::min(p + i, last)]]);
      const auto found = tree.nearest(images, limit * limit, near);
      for (Index i = 0; i < PointTree::block && p + i < end; ++i)
        pairs(order[p + i], 1) = found[i].index;
    }
  });
}

}  // namespace

void set_pair(Result& result, Index row, const Vector3& x, const Vector3& y, const Mirror& mirror) {
  result.residuals[row] = (mirror.reflect(x) - y).norm();
  result.surface_points.row(row) = (x + y).transpose() / 2;
}

// Little is held beside the tree, and beside the result: at a million points that is what counts.
void add_pairs(Result& result, PointsView points, PointTree&& tree, const Mirror& mirror,
               double limit, const Context& context) {
  if (context.communicator())
    return add_shared_pairs(result, points, std::move(tree), mirror, limit, context);
  Pairs& pairs = result.pairs;
  pairs.setConstant(points.size(), 2, -1);
  {
    const PointTree consumed = std::move(tree);
    find_partners(points, consumed, mirror, limit, context, pairs);
  }
  Index found = 0;
  for (Index i = 0; i < points.size(); ++i)
    if (const Index partner = pairs(i, 1); partner >= 0) pairs.row(found++) << i, partner;
  pairs.conservativeResize(found, 2);

  result.residuals.resize(found);
  result.surface_points.resize(found, 3);
  for (Index row = 0; row < found; ++row)
    set_pair(result, row, points[pairs(row, 0)], points[pairs(row, 1)], mirror);
}

}  // namespace symsurf
