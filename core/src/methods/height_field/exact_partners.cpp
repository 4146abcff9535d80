#include "methods/height_field/exact_partners.h"

#include <algorithm>
#include <cmath>

#include "methods/height_field/height_field_pairing.h"

namespace symsurf {

namespace {

constexpr Index tried_peaks = 8;
constexpr double exact_angle = 1e-5;  // chords agree to this, or have no exact partners
constexpr Index least_pairs = 8;
constexpr double convincing_share = 0.7;  // of all points: no need to look further
constexpr double rounding = 1e-9;

Points midpoints(const WorkingCloud& cloud, const std::vector<ChordPair>& pairs) {
  Points points(static_cast<Index>(pairs.size()), 3);
  for (Index i = 0; i < points.rows(); ++i)
    points.row(i) = (cloud.points.row(pairs[i].first) + cloud.points.row(pairs[i].second)) / 2;
  return points;
}

}  // namespace

FieldEstimate exact_partners(const WorkingCloud& cloud, const std::vector<ChordPeak>& peaks,
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
    if (share > convincing_share) break;
  }
  return best;
}

}  // namespace symsurf
