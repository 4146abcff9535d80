#include "matching.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "parallel.h"

namespace symsurf {

namespace {

// Along the tree's curve.
std::vector<std::int32_t> rows_to_pair(const PointTree& tree, const Rows& rows) {
  std::vector<std::int32_t> order;
  std::copy_if(tree.order().begin(), tree.order().end(), std::back_inserter(order),
               [&](std::int32_t row) { return rows.contains(row); });
  return order;
}

// The index of each point's partner, -1: none.
std::vector<std::int32_t> partners(PointsView points, const PointTree& tree, const Mirror& mirror,
                                   double limit, const Context& context) {
  constexpr Index grain = 4096;
  std::vector<std::int32_t> partner(points.size(), -1);
  const std::vector<std::int32_t> order = rows_to_pair(tree, context.paired_rows());
  parallel_for(context, static_cast<Index>(order.size()), grain, [&](Index begin, Index end) {
    Index near = begin;
    for (Index p = begin; p < end; p += PointTree::block) {
      const Index last = end - 1;
      PointTree::Queries images;
      for (Index i = 0; i < PointTree::block; ++i)
        images.col(i) = mirror.reflect(points[order[std::min(p + i, last)]]);
      const auto found = tree.nearest(images, limit * limit, near);
      for (Index i = 0; i < PointTree::block && p + i < end; ++i)
        partner[order[p + i]] = static_cast<std::int32_t>(found[i].index);
    }
  });
  return partner;
}

}  // namespace

void add_pairs(Result& result, PointsView points, PointTree&& tree, const Mirror& mirror,
               double limit, const Context& context) {
  std::vector<std::int32_t> partner;
  {
    const PointTree consumed = std::move(tree);
    partner = partners(points, consumed, mirror, limit, context);
  }

  const Index found = points.size() - std::count(partner.begin(), partner.end(), -1);
  result.pairs.resize(found, 2);
  result.residuals.resize(found);
  result.surface_points.resize(found, 3);
  for (Index i = 0, row = 0; i < points.size(); ++i) {
    if (partner[i] < 0) continue;
    const Vector3 x = points[i], y = points[partner[i]];
    result.pairs.row(row) << i, partner[i];
    result.residuals[row] = (mirror.reflect(x) - y).norm();
    result.surface_points.row(row) = (x + y).transpose() / 2;
    ++row;
  }
}

}  // namespace symsurf
