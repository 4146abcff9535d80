#include "fixed_direction/field_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/eigenvectors.h"
#include "fixed_direction/mapping_directions.h"
#include "fixed_direction/partner_evidence.h"
#include "fixed_direction/surface_refinement.h"

namespace symsurf {

namespace {

constexpr Index peaks_a_scale = 6, best_directions = 3;
constexpr Index searched_size = 2000;
constexpr double exact_share = 0.2;  // of the points have exact partners: no chance
constexpr double peak_cone = 0.03, evidence_cone = 0.005;  // radians
constexpr double evidence_reach = 1.7;                     // spacings
constexpr double no_evidence = 5;                     // standard deviations that chance reaches
constexpr double known_scatter = 7;                   // from here on the scatter is believed
constexpr double strong_evidence = 9;                 // no need to look further
constexpr double rough_surfaces = 0.1155;             // spacings off a plane: noise, or sharp bends
constexpr Index smooth_patch = 14, rough_patch = 32;  // neighbours
constexpr int rounds = 6;

// The direction whose surface has most support, and the partners found along it.
class MostSupported {
 public:
  MostSupported(const SurfacePoints& cloud, const Context& context)
      : cloud_(cloud), context_(context), surface_(cloud, context, evidence_reach) {}

  void consider(const std::vector<Vector3>& directions) {
    const Vector3* most = nullptr;
    for (const Vector3& direction : directions) {
      context_.check();
      const double support = surface_.support(direction);
      if (support <= support_) continue;
      support_ = support;
      most = &direction;
    }
    if (most) examine(*most);
  }
  const PartnerEvidence& evidence() const { return evidence_; }

 private:
  void examine(const Vector3& direction) {
    surface_.support(direction);
    context_.check();
    evidence_ = partner_evidence(surface_, cloud_, direction, context_);
    if (evidence_.significance <= no_evidence) evidence_.direction = direction;
    if (evidence_.significance <= known_scatter)
      evidence_.scatter = std::numeric_limits<double>::infinity();
  }

  const SurfacePoints& cloud_;
  const Context& context_;
  MidSurface surface_;
  PartnerEvidence evidence_;
  double support_ = -1;
};

template <typename Directed>
std::vector<Vector3> directions(const std::vector<Directed>& of) {
  std::vector<Vector3> all;
  for (const Directed& one : of) all.push_back(one.direction);
  return all;
}

std::vector<Vector3> supported_directions(const SurfacePoints& cloud,
                                          const std::vector<ChordPeak>& peaks,
                                          const Context& context) {
  if (cloud.size() <= searched_size)
    return directions(supported_directions(cloud, peaks, best_directions, context));
  const SurfacePoints fewer(cloud.points, searched_size, context.stage(0, 0));
  return directions(supported_directions(fewer, peaks, best_directions, context));
}

}  // namespace

FieldEstimate find_height_field(const SurfacePoints& cloud, const Vector3& given_direction,
                                Values& statistics, const Context& context) {
  std::vector<ChordPeak> peaks;
  const bool given = !given_direction.isZero(0);
  if (given)
    peaks.push_back({given_direction.normalized(), 0});
  else
    peaks = chord_peaks(cloud, peaks_a_scale, context);
  context.report(0.2);

  const FieldEstimate exact = exact_partners(cloud, peaks, peak_cone, context);
  statistics["partners"] = std::string("exact");
  if (exact.support > exact_share) return exact;
  context.report(0.3);

  MostSupported most(cloud, context);
  most.consider(directions(peaks));
  context.report(0.4);
  if (!given && most.evidence().significance < strong_evidence)
    most.consider(supported_directions(cloud, peaks, context.stage(0.4, 0.7)));
  context.report(0.7);

  const PartnerEvidence& start = most.evidence();
  statistics["partner_significance"] = start.significance;
  if (start.significance > strong_evidence) {
    const FieldEstimate again =
        exact_partners(cloud, {{start.direction, 0}}, evidence_cone, context);
    if (again.support > exact_share) return again;
  }
  statistics["partners"] = std::string("sheets");
  const bool rough = cloud.noise > rough_surfaces * cloud.spacing;
  const SurfacePatches patches(cloud, rough ? rough_patch : smooth_patch, context);
  context.report(0.75);
  return SurfaceRefinement(cloud, patches, context)(start.direction, start.scatter, rounds);
}

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
