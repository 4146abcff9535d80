#include <symsurf/context.h>
#include <symsurf/parameter.h>
#include <symsurf/points.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/voxel_grid.h"

namespace symsurf {

namespace {

// The grids of cells l_avg / k over a cloud whose points are not all equal.
class Grids {
 public:
  Grids(PointsView points, const Context& context) : points_(points), context_(context) {
    low_ = points.matrix().colwise().minCoeff();
    const Vector3 high = points.matrix().colwise().maxCoeff();
    extent_ = (high - low_).maxCoeff();
    if (!std::isfinite(extent_) || !std::isnormal(extent_ / finest))
      throw InvalidInput("the points span " + to_string(Value(extent_)) +
                         "; no grid can be laid over so much or so little");
    l_avg_ = mean_distance_from_centroid();
  }

  Triple cell(Index k, Index i) const {
    const Vector3 x = (points_[i] - low_) * (static_cast<double>(k) / l_avg_);
    return {static_cast<std::int64_t>(x.x()), static_cast<std::int64_t>(x.y()),
            static_cast<std::int64_t>(x.z())};
  }

  bool occupies(Index k, Index count) const {
    TripleIndex cells;
    for (Index i = 0; i < points_.size(); ++i) {
      context_.check();
      if (cells.add(cell(k, i)) + 1 >= count) return true;
    }
    return false;
  }

  // Below the rounding error of the coordinates, cells separate points that are equal.
  bool is_finest(Index k) const { return extent_ * (static_cast<double>(k) / l_avg_) > finest; }

  // The first k of 1, 2, 3, ... with `count` occupied cells.
  Index first_with(Index count) const {
    // A cell meets at most eight cells of any coarser grid: while a grid has fewer than an eighth
    // of the cells, none of the coarser ones can have enough.
    Index k = 1;
    while (!is_finest(2 * k) && !occupies(2 * k, (count + 7) / 8)) k *= 2;
    while (!is_finest(k) && !occupies(k, count)) k += step(k);
    return k;
  }

 private:
  static constexpr double finest = 0x1p51;  // cells along the longest side

  static Index step(Index k) {
    constexpr Index steps_an_octave = 64;
    return std::max<Index>(
        1, static_cast<Index>(std::bit_floor(static_cast<std::uint64_t>(k))) / steps_an_octave);
  }

  // In units of the extent, where squares neither overflow nor vanish.
  double mean_distance_from_centroid() const {
    const auto unit = [&](Index i) -> Vector3 { return (points_[i] - low_) / extent_; };
    const double n = static_cast<double>(points_.size());
    Vector3 centroid = Vector3::Zero();
    for (Index i = 0; i < points_.size(); ++i) centroid += unit(i);
    centroid /= n;
    double sum = 0;
    for (Index i = 0; i < points_.size(); ++i) sum += (unit(i) - centroid).norm();
    return sum / n * extent_;
  }

  PointsView points_;
  const Context& context_;
  Vector3 low_;
  double extent_, l_avg_;
};

// The means of the points of equal triples, in lexicographic order of these.
template <typename TripleOf>
Points means(PointsView points, const Context& context, const TripleOf& triple_of) {
  TripleIndex groups;
  // Relative to a group's first point: a group of one keeps its bits, far-off ones their digits.
  std::vector<Vector3> first, sum;
  std::vector<Index> members;
  for (Index i = 0; i < points.size(); ++i) {
    context.check();
    const Index group = groups.add(triple_of(i));
    if (group == static_cast<Index>(first.size())) {
      first.push_back(points[i]);
      sum.push_back(Vector3::Zero());
      members.push_back(0);
    }
    sum[group] += points[i] - first[group];
    ++members[group];
  }
  std::vector<Index> order(groups.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return groups[a] < groups[b]; });
  Points result(groups.size(), 3);
  for (Index row = 0; row < result.rows(); ++row) {
    const Index group = order[row];
    result.row(row) = first[group] + sum[group] / static_cast<double>(members[group]);
  }
  return result;
}

bool has_more_distinct_than(PointsView points, Index count, const Context& context) {
  TripleIndex distinct;
  for (Index i = 0; i < points.size(); ++i) {
    context.check();
    if (distinct.add(ordered_bits(points[i])) >= count) return true;
  }
  return false;
}

}  // namespace

Points downsample(PointsView points, Index count, const Context& context) {
  if (count < 1)
    throw InvalidParameter("count is " + std::to_string(count) + "; allowed is 1 and above");
  if (points.empty()) throw InvalidInput("no points given; at least 1 is needed");
  require_finite(points, "point");
  if (!has_more_distinct_than(points, count, context))
    return means(points, context, [&](Index i) { return ordered_bits(points[i]); });
  const Grids grids(points, context);
  const Index k = grids.first_with(count);
  return means(points, context, [&](Index i) { return grids.cell(k, i); });
}

}  // namespace symsurf
