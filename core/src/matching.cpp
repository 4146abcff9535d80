#include "matching.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "parallel.h"
#include "point_grid.h"
#include "shared_matching.h"

namespace symsurf {

namespace {

// Of each point; -1: none.
struct Partners {
  std::vector<std::int32_t> index;
  Eigen::VectorXd distance;  // from the image

  explicit Partners(Index size) : index(size), distance(size) {}

  void set(Index i, const Neighbour& found) {
    index[i] = static_cast<std::int32_t>(found.index);
    distance[i] = std::sqrt(found.squared_distance);
  }
};

Partners find_partners(PointsView points, const PointTree& tree, const Mirror& mirror, double limit,
                       const Context& context) {
  constexpr Index grain = 1024;
  Partners partners(points.size());
  if (const std::optional<PointGrid> grid = PointGrid::where_faster(points)) {
    parallel_for(context, points.size(), grain, [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i)
        partners.set(i, grid->nearest(mirror.reflect(points[i]), limit * limit));
    });
    return partners;
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
        partners.set(order[p + i], found[i]);
    }
  });
  return partners;
}

}  // namespace

// Little is held beside the tree, and beside the result: at a million points that is what counts.
void add_pairs(Result& result, PointsView points, PointTree&& tree, const Mirror& mirror,
               double limit, const Context& context) {
  if (context.communicator())
    return add_shared_pairs(result, points, std::move(tree), mirror, limit, context);
  Partners partners(0);
  {
    const PointTree consumed = std::move(tree);
    partners = find_partners(points, consumed, mirror, limit, context);
  }
  const Index size = points.size();
  const Index found = size - std::count(partners.index.begin(), partners.index.end(), -1);
  // The largest first, into the space that the tree left.
  result.surface_points.resize(found, 3);
  Pairs& pairs = result.pairs;
  pairs.resize(found, 2);
  Index row = 0;
  interruptible_for(context, size, [&](Index i) {
    const Index partner = partners.index[i];
    if (partner < 0) return;
    partners.distance[row] = partners.distance[i];
    pairs.row(row++) << i, partner;
  });
  partners.index = std::vector<std::int32_t>();
  result.residuals = std::move(partners.distance);
  result.residuals.conservativeResize(found);
  interruptible_for(context, found, [&](Index k) {
    result.surface_points.row(k) = (points[pairs(k, 0)] + points[pairs(k, 1)]).transpose() / 2;
  });
}

void keep_pairs(Result& result, const std::vector<Index>& rows) {
  result.pairs = Pairs(result.pairs(rows, Eigen::indexing::all));
  result.residuals = Eigen::VectorXd(result.residuals(rows));
  result.surface_points = Points(result.surface_points(rows, Eigen::indexing::all));
}

}  // namespace symsurf
