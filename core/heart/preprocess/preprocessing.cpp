#include "preprocess/preprocessing.h"

#include <symsurf/context.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/radix_sort.h"
#include "cloud/cloud.h"
#include "cloud/triangle_mesh.h"
#include "cloud/voxel_grid.h"
#include "pairing/matching.h"
#include "preprocess/boundary.h"
#include "preprocess/surface_samples.h"

namespace symsurf {

void Stage::replace(Cloud& cloud, Points points, Points normals) {
  points_ = std::move(points);
  normals_ = std::move(normals);
  cloud.set_points(points_, normals_);
}

std::vector<std::unique_ptr<Stage>> make_stages(const Preprocessing& policy, Index minimum_points,
                                                const ParameterValues& values,
                                                bool refuse_nonfinite) {
  std::vector<std::unique_ptr<Stage>> stages;
  stages.push_back(std::make_unique<NonfiniteRemoval>(minimum_points, refuse_nonfinite));
  if (policy.remove_outliers) stages.push_back(std::make_unique<OutlierRemoval>(minimum_points));
  if (policy.sample_faces) stages.push_back(std::make_unique<SurfaceSamples>());
  if (policy.merge_duplicates) stages.push_back(std::make_unique<DuplicateMerge>(minimum_points));
  if (policy.order_points) stages.push_back(std::make_unique<PositionOrder>());
  if (policy.extract_boundary)
    stages.push_back(
        std::make_unique<BoundaryExtraction>(minimum_points, policy.keep_interior, values));
  return stages;
}

void RowStage::map_back(Result& result, PairDistance, const Context&) const {
  std::vector<Index> row_of(rows_.first.size(), -1), paired, rows;
  for (Index row = 0; row < result.pairs.rows(); ++row) row_of[result.pairs(row, 0)] = row;
  for (std::size_t i = 0; i < rows_.number.size(); ++i) {
    if (rows_.number[i] < 0) continue;
    const Index row = row_of[rows_.number[i]];
    if (row < 0) continue;
    paired.push_back(static_cast<Index>(i));
    rows.push_back(row);
  }
  keep_pairs(result, rows);
  for (Index row = 0; row < result.pairs.rows(); ++row)
    result.pairs.row(row) << paired[row], rows_.first[result.pairs(row, 1)];
}

bool RowRemoval::remove(Cloud& cloud, const std::vector<Index>& own) {
  if (own.empty()) return false;
  rows_ = without(cloud.points.size(), own);
  faces_ = renumbered(cloud.faces, rows_);
  cloud.faces = faces_;
  replace(cloud, chosen_rows(cloud.points, rows_.first), chosen_rows(cloud.normals, rows_.first));
  return true;
}

DistinctPoints RowRemoval::without(Index points, const std::vector<Index>& removed) {
  DistinctPoints kept;
  kept.number.resize(points, 0);
  for (const Index i : removed) kept.number[i] = -1;
  for (Index i = 0; i < points; ++i) {
    if (kept.number[i] < 0) continue;
    kept.number[i] = static_cast<std::int32_t>(kept.first.size());
    kept.first.push_back(static_cast<std::int32_t>(i));
  }
  return kept;
}

Triangles RowRemoval::renumbered(TrianglesView faces, const DistinctPoints& kept) {
  Triangles left(faces.size(), 3);
  Index row = 0;
  for (Index f = 0; f < faces.size(); ++f) {
    for (int c = 0; c < 3; ++c) left(row, c) = kept.number[faces[f][c]];
    row += left.row(row).minCoeff() >= 0;
  }
  left.conservativeResize(row, 3);
  return left;
}

void RowRemoval::map_back(Result& result, PairDistance pair_distance,
                          const Context& context) const {
  RowStage::map_back(result, pair_distance, context);
  result.statistics[statistic_] = static_cast<Index>(rows_.number.size() - rows_.first.size());
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
  rows_ = distinct_points(cloud.points, context);
  if (static_cast<Index>(rows_.first.size()) < minimum_points_)
    throw InvalidInput(std::to_string(cloud.points.size()) + " points given, " +
                       std::to_string(rows_.first.size()) + " of them distinct; at least " +
                       std::to_string(minimum_points_) + " distinct points are needed");
  keep(cloud, rows_.first);
  return true;
}

bool PositionOrder::apply(Cloud& cloud, const Context& context) {
  const PointsView points = cloud.points;
  std::vector<std::int32_t>& order = rows_.first;
  order.resize(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<std::uint64_t> keys(points.size());
  for (const int axis : {2, 1, 0}) {
    interruptible_for(context, points.size(), [&](Index row) {
      keys[row] = static_cast<std::uint64_t>(ordered_bits(points[order[row]])[axis]) ^
                  std::uint64_t{1} << 63;
    });
    radix_sort(keys, order, context);
  }
  if (std::is_sorted(order.begin(), order.end())) return false;
  rows_.number.resize(order.size());
  for (std::size_t row = 0; row < order.size(); ++row)
    rows_.number[order[row]] = static_cast<std::int32_t>(row);
  keep(cloud, order);
  return true;
}

namespace {

// The body, all that are no outliers, is made of connected parts with at least one in twenty of the
// points each, holds most points, and spans less than half of the diagonal.
constexpr double least_part = 0.05, least_share = 0.85, most_extent = 0.5;

// The cells over a cloud that hold its body, or touch it.
class Body {
 public:
  Body(PointsView points, const PrincipalFrame& frame, const Context& context)
      : frame_(frame), grid_(frame.low, frame.high, edge) {
    Counts counts = counts_of(points, context);
    count_duplicates_once(points, counts);
    total_ = counts.sum();
    holding_.assign(counts.size(), false);
    VoxelGrid::Cell low = grid_.cell_of(frame.high), high = grid_.cell_of(frame.low);
    for (const Index k : large_parts(counts)) {
      const VoxelGrid::Cell cell = grid_.cell(k);
      low = low.cwiseMin(cell);
      high = high.cwiseMax(cell);
      grid_.for_each_touching(k, [&](Index other) { holding_[other] = true; });
    }
    extent_ = edge * (high - low + VoxelGrid::Cell::Ones()).cast<double>().norm();
    for (std::size_t k = 0; k < holding_.size(); ++k)
      if (holding_[k]) held_ += counts[k];
  }

  /// The number of points; many equal ones apart from the others count once.
  Index total() const { return total_; }

  /// Of these, what the cells hold.
  Index held() const { return held_; }

  bool has_outliers() const { return held_ < total_ && extent_ < most_extent; }

  bool holds(const Vector3& x) const { return holding_[voxel_of(x)]; }

 private:
  using Counts = Eigen::ArrayX<Index>;
  static constexpr double edge = 1. / 16;  // diagonals

  Index voxel_of(const Vector3& x) const { return grid_.index(grid_.cell_of(frame_.to_frame(x))); }

  Counts counts_of(PointsView points, const Context& context) const {
    constexpr Index grain = 1 << 16;
    const Counts none = Counts::Zero(grid_.size());
    return parallel_sum(context, points.size(), grain, none, [&](Index begin, Index end) {
      Counts counts = none;
      for (Index i = begin; i < end; ++i) ++counts[voxel_of(points[i])];
      return counts;
    });
  }

  // Pixels without depth, written as the origin, are often more than any part of the body.
  void count_duplicates_once(PointsView points, Counts& counts) const {
    const double many = least_part * static_cast<double>(counts.sum());
    for (Index k = 0; k < counts.size(); ++k) {
      if (static_cast<double>(counts[k]) < many || counts[k] < 2) continue;
      Index around = 0;
      grid_.for_each_touching(k, [&](Index other) { around += counts[other]; });
      if (around == counts[k] && are_equal_in(points, k)) counts[k] = 1;
    }
  }

  bool are_equal_in(PointsView points, Index voxel) const {
    std::optional<Vector3> first;
    for (Index i = 0; i < points.size(); ++i) {
      if (voxel_of(points[i]) != voxel) continue;
      if (!first) first = points[i];
      if (points[i] != *first) return false;
    }
    return true;
  }

  // The cells of all connected parts with more points than outliers have, and than would come
  // together by chance of as many outliers as there may be, anywhere in the box.
  std::vector<Index> large_parts(const Counts& counts) const {
    const auto total = static_cast<double>(total_);
    const double box = ((frame_.high - frame_.low) / edge).array().ceil().max(1).prod();
    const auto least = static_cast<Index>(2 + 4 * (1 - least_share) * total / box);
    std::vector<bool> seen(counts.size(), false);
    std::vector<Index> cells;
    for (Index start = 0; start < counts.size(); ++start) {
      const std::size_t first = cells.size();
      Index held = 0;
      const auto reach = [&](Index k) {
        if (seen[k] || counts[k] < least) return;
        seen[k] = true;
        held += counts[k];
        cells.push_back(k);
      };
      reach(start);
      for (std::size_t k = first; k < cells.size(); ++k) grid_.for_each_touching(cells[k], reach);
      if (static_cast<double>(held) < least_part * total) cells.resize(first);
    }
    return cells;
  }

  PrincipalFrame frame_;
  VoxelGrid grid_;
  std::vector<bool> holding_;
  Index total_ = 0, held_ = 0;
  double extent_ = 0;
};

bool fills_area(const PrincipalFrame& frame) {
  constexpr double thinness = 1e-7;
  return frame.variance[1] > thinness * thinness * frame.variance[0];
}

}  // namespace

bool OutlierRemoval::apply(Cloud& cloud, const Context& context) {
  const bool merge = has_many_duplicates(cloud.points, context);
  const DistinctPoints distinct = merge ? distinct_points(cloud.points, context) : DistinctPoints();
  const Points positions = merge ? chosen_rows(cloud.points, distinct.first) : Points(0, 3);
  const PointsView points = merge ? PointsView(positions) : cloud.points;
  std::vector<Index> own = outliers_of(points, cloud, context);
  if (merge) {
    std::vector<bool> is_outlier(distinct.first.size(), false);
    for (const Index i : own) is_outlier[i] = true;
    own.clear();
    for (std::size_t i = 0; i < distinct.number.size(); ++i)
      if (is_outlier[distinct.number[i]]) own.push_back(static_cast<Index>(i));
  }
  if (!own.empty() && !cloud.faces.empty() && hold_surface(own, cloud)) return false;
  return remove(cloud, own);
}

// Of these points of the cloud, ascending.
std::vector<Index> OutlierRemoval::outliers_of(PointsView points, const Cloud& cloud,
                                               const Context& context) const {
  const bool merged = points.size() < cloud.points.size();
  Body body(points, merged ? principal_frame(points, context) : cloud.frame, context);
  const double share = least_share * static_cast<double>(body.total());
  const Index least = std::max(minimum_points_, static_cast<Index>(std::ceil(share)));
  std::vector<Index> own;
  while (body.has_outliers() && body.held() >= least) {
    const std::vector<Index> known = own;
    own.clear();
    auto next = known.begin();
    interruptible_for(context, points.size(), [&](Index i) {
      const bool is_known = next != known.end() && *next == i;
      if (is_known) ++next;
      if (is_known || !body.holds(points[i])) own.push_back(i);
    });
    const Points left = chosen_rows(points, without(points.size(), own).first);
    const PrincipalFrame frame = principal_frame(left, context);
    if (!fills_area(frame)) return known;
    body = Body(left, frame, context);
  }
  return own;
}

bool OutlierRemoval::hold_surface(const std::vector<Index>& own, const Cloud& cloud) {
  const DistinctPoints rest = without(cloud.points.size(), own);
  const double left =
      surface_area(chosen_rows(cloud.points, rest.first), renumbered(cloud.faces, rest));
  return left < (1 - least_part) * surface_area(cloud.points, cloud.faces);
}

}  // namespace symsurf
