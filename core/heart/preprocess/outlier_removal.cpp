#include "preprocess/outlier_removal.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "cloud/distinct_points.h"
#include "cloud/triangle_mesh.h"
#include "cloud/voxel_grid.h"

namespace symsurf {

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
    const Points left = without(points, own);
    const PrincipalFrame frame = principal_frame(left, context);
    if (!fills_area(frame)) return known;
    body = Body(left, frame, context);
  }
  return own;
}

bool OutlierRemoval::hold_surface(const std::vector<Index>& own, const Cloud& cloud) {
  const Points rest = without(cloud.points, own);
  const double left = surface_area(rest, without(cloud.faces, own, cloud.points.size()));
  return left < (1 - least_part) * surface_area(cloud.points, cloud.faces);
}

}  // namespace symsurf
