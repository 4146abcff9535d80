#include "preprocess/row_stages.h"

#include <symsurf/context.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/radix_sort.h"
#include "cloud/voxel_grid.h"
#include "pairing/matching.h"

namespace symsurf {

bool RowRemoval::remove(Cloud& cloud, const std::vector<Index>& own) {
  removed_ = own;
  if (removed_.empty()) return false;
  faces_ = without(cloud.faces, own, cloud.points.size());
  cloud.faces = faces_;
  replace(cloud, without(cloud.points, own),
          cloud.normals.empty() ? Points(0, 3) : without(cloud.normals, own));
  return true;
}

Points RowRemoval::without(PointsView rows, const std::vector<Index>& removed) {
  Points left(rows.size() - static_cast<Index>(removed.size()), 3);
  Index begin = 0, written = 0;
  const auto copy_up_to = [&](Index end) {
    left.middleRows(written, end - begin) = rows.matrix().middleRows(begin, end - begin);
    written += end - begin;
    begin = end + 1;
  };
  for (const Index i : removed) copy_up_to(i);
  copy_up_to(rows.size());
  return left;
}

Triangles RowRemoval::without(TrianglesView faces, const std::vector<Index>& removed,
                              Index points) {
  if (faces.empty()) return Triangles(0, 3);
  std::vector<Index> number(points);
  auto next = removed.begin();
  for (Index i = 0, left = 0; i < points; ++i) {
    const bool is_removed = next != removed.end() && *next == i;
    number[i] = is_removed ? -1 : left++;
    if (is_removed) ++next;
  }
  Triangles left(faces.size(), 3);
  Index row = 0;
  for (Index f = 0; f < faces.size(); ++f) {
    const Index* corner = faces[f];
    left.row(row) << number[corner[0]], number[corner[1]], number[corner[2]];
    row += left.row(row).minCoeff() >= 0;
  }
  left.conservativeResize(row, 3);
  return left;
}

void RowRemoval::map_back(Result& result, PairDistance, const Context&) const {
  // As many removed points are before a point as have no more others before them than it has.
  const auto numbered = [&](Index other) {
    const auto is_before = [&](const Index& removed) {
      return removed - (&removed - removed_.data()) <= other;
    };
    const auto after = std::partition_point(removed_.begin(), removed_.end(), is_before);
    return other + (after - removed_.begin());
  };
  result.pairs = result.pairs.unaryExpr(numbered).eval();
  result.statistics[statistic_] = static_cast<Index>(removed_.size());
}

bool NonfiniteRemoval::apply(Cloud& cloud, const Context&) {
  const PointsView own = cloud.points;
  std::vector<Index> nonfinite;
  if (!refuse_ && is_numerable(own.size()) && !are_finite(own))
    for (Index i = 0; i < own.size(); ++i)
      if (!own[i].allFinite()) nonfinite.push_back(i);
  if (nonfinite.empty()) return false;
  require_normals(own, cloud.normals);
  const Index left = own.size() - static_cast<Index>(nonfinite.size());
  const Index needed = needed_points(cloud, minimum_points_);
  if (left < needed)
    throw InvalidInput(std::to_string(left) + " of " + std::to_string(own.size()) +
                       " points given are finite; at least " + std::to_string(needed) +
                       (needed == 1 ? " is needed" : " are needed"));
  return remove(cloud, nonfinite);
}

bool DuplicateMerge::apply(Cloud& cloud, const Context& context) {
  if (!has_many_duplicates(cloud.points, context)) return false;
  distinct_ = distinct_points(cloud.points, context);
  if (static_cast<Index>(distinct_.first.size()) < minimum_points_)
    throw InvalidInput(std::to_string(cloud.points.size()) + " points given, " +
                       std::to_string(distinct_.first.size()) + " of them distinct; at least " +
                       std::to_string(minimum_points_) + " distinct points are needed");
  keep(cloud, distinct_.first);
  return true;
}

void DuplicateMerge::map_back(Result& result, PairDistance, const Context&) const {
  std::vector<Index> row_of(distinct_.first.size(), -1);
  for (Index row = 0; row < result.pairs.rows(); ++row) row_of[result.pairs(row, 0)] = row;
  std::vector<Index> paired, rows;
  for (std::size_t i = 0; i < distinct_.number.size(); ++i) {
    const Index row = row_of[distinct_.number[i]];
    if (row < 0) continue;
    paired.push_back(static_cast<Index>(i));
    rows.push_back(row);
  }
  keep_pairs(result, rows);
  for (Index row = 0; row < result.pairs.rows(); ++row)
    result.pairs.row(row) << paired[row], distinct_.first[result.pairs(row, 1)];
}

bool PositionOrder::apply(Cloud& cloud, const Context& context) {
  const PointsView points = cloud.points;
  order_.resize(points.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<std::uint64_t> keys(points.size());
  for (const int axis : {2, 1, 0}) {
    interruptible_for(context, points.size(), [&](Index row) {
      keys[row] = static_cast<std::uint64_t>(ordered_bits(points[order_[row]])[axis]) ^
                  std::uint64_t{1} << 63;
    });
    radix_sort(keys, order_, context);
  }
  if (std::is_sorted(order_.begin(), order_.end())) return false;
  keep(cloud, order_);
  return true;
}

void PositionOrder::map_back(Result& result, PairDistance, const Context&) const {
  std::vector<Index> row_of(order_.size(), -1), rows;
  for (Index row = 0; row < result.pairs.rows(); ++row) {
    for (Index& point : result.pairs.row(row)) point = order_[point];
    row_of[result.pairs(row, 0)] = row;
  }
  std::copy_if(row_of.begin(), row_of.end(), std::back_inserter(rows),
               [](Index row) { return row >= 0; });
  keep_pairs(result, rows);
}

}  // namespace symsurf
