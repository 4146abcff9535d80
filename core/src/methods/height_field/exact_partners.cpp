#include "methods/height_field/exact_partners.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/symmetric_eigen.h"

namespace symsurf {

namespace {

constexpr Index tried_peaks = 8;
constexpr double exact_angle = 1e-5;  // chords agree to this, or have no exact partners
constexpr Index least_pairs = 8;
constexpr double enough_share = 0.7;  // of all points: no need to search on
constexpr double rounding = 1e-9;

using ChordPair = std::pair<Index, Index>;

// Pairs of points that lie over each other along the direction within `tolerance`: no plane need
// separate them. Of 2k points on one line the first goes with the last, the second with the last
// but one: nested, all with one midpoint.
std::vector<ChordPair> nested_pairs(const SurfacePoints& cloud, const Vector3& direction,
                                    double tolerance) {
  const Eigen::VectorXd heights = cloud.points * direction;
  const Points flat = cloud.points - heights * direction.transpose();
  const PointTree tree(flat);
  std::vector<ChordPair> pairs;
  std::vector<Index> line;
  for (Index i = 0; i < cloud.size(); ++i) {
    line.clear();
    tree.within(flat.row(i).transpose(), tolerance, [&](Index j, double) { line.push_back(j); });
    if (*std::min_element(line.begin(), line.end()) != i) continue;  // each line once
    std::sort(line.begin(), line.end(), [&](Index a, Index b) {
      return heights[a] != heights[b] ? heights[a] < heights[b] : a < b;
    });
    for (std::size_t low = 0, high = line.size() - 1; low < high; ++low, --high)
      pairs.emplace_back(line[low], line[high]);
  }
  return pairs;
}

// The direction that all the pairs' chords share best: least squares of their offsets across it.
Vector3 common_direction(const SurfacePoints& cloud, const std::vector<ChordPair>& pairs) {
  Matrix3 scatter = Matrix3::Zero();
  for (const auto& [a, b] : pairs) {
    const Vector3 chord = cloud.point(b) - cloud.point(a);
    scatter += chord * chord.transpose();
  }
  return eigen_of(scatter).vectors.col(2);
}

Points midpoints(const SurfacePoints& cloud, const std::vector<ChordPair>& pairs) {
  Points points(static_cast<Index>(pairs.size()), 3);
  for (Index i = 0; i < points.rows(); ++i)
    points.row(i) = (cloud.points.row(pairs[i].first) + cloud.points.row(pairs[i].second)) / 2;
  return points;
}

}  // namespace

FieldEstimate exact_partners(const SurfacePoints& cloud, const std::vector<ChordPeak>& peaks,
                             double cone, const Context& context) {
  FieldEstimate best;
  double best_rank = 0;
  for (std::size_t k = 0; k < peaks.size() && k < tried_peaks; ++k) {
    context.check();
    const SharpDirection sharp = sharpened(cloud, peaks[k].direction, cone);
    if (sharp.angle > exact_angle || sharp.chords < least_pairs) continue;
    const double tolerance = std::max(rounding, 4 * sharp.angle);
    const auto rough_pairs = nested_pairs(cloud, sharp.direction, tolerance);
    if (static_cast<Index>(rough_pairs.size()) < least_pairs) continue;
    context.check();
    const Vector3 v = common_direction(cloud, rough_pairs);
    const auto pairs = nested_pairs(cloud, v, tolerance);
    double squareness = 0;
    for (const auto& [a, b] : pairs)
      squareness += std::abs(cloud.normal(a).dot(v) * cloud.normal(b).dot(v));
    const double count = static_cast<double>(pairs.size());
    const double share = 2 * count / static_cast<double>(cloud.size());
    const double rank = share * std::sqrt(squareness / count);
    if (!(rank > best_rank)) continue;
    best_rank = rank;
    best = {v, midpoints(cloud, pairs), share};
    if (share > enough_share) break;
  }
  return best;
}

}  // namespace symsurf
