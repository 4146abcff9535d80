#include "fixed_direction/fixed_direction.h"

#include <symsurf/mirrors.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "pairing/matching.h"
#include "score/mirror_score.h"
#include "search/methods.h"

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
    const double tolerance = std::max(double_rounding, 4 * sharp.angle);
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

namespace {

constexpr double far_residual = 6;      // median residuals: a partner by chance
constexpr double far_at_least = 1e-6;   // spacings
constexpr Index known_neighbours = 16;  // both ends of a pair share a surface point
constexpr double near = 2;              // spacings: an image's neighbour
constexpr double one_sided = 0.5;

// Between exact pairs the surface is known; beyond them, as at a hole's rim, it is a guess.
bool surrounded(const Vector3& x, const Points& known, const PointTree& tree,
                std::vector<Neighbour>& found) {
  tree.nearest(x, known_neighbours, found);
  Vector3 pull = Vector3::Zero();
  for (const Neighbour& n : found) {
    const Vector3 way = known.row(n.index).transpose() - x;
    if (way.norm() > 0) pull += way.normalized();
  }
  return pull.norm() < one_sided * static_cast<double>(found.size());
}

// Drops pairs by chance: where one side is missing, images fall on whatever lies at the gap's rim.
// Kept is what fits about as well as most pairs do and, where most are exact, neighbours of an
// image among exact pairs. `spacing`: of the points on a surface, in input units.
void keep_consistent_pairs(Result& result, double spacing, const Context& context) {
  const Eigen::VectorXd& residuals = result.residuals;
  if (residuals.size() == 0) return;
  const double typical = median(std::vector(residuals.begin(), residuals.end()));
  const double limit = std::max(far_residual * typical, far_at_least * spacing);
  std::vector<Index> consistent, doubtful;
  for (Index i = 0; i < residuals.size(); ++i) {
    if (residuals[i] <= limit)
      consistent.push_back(i);
    else if (residuals[i] <= near * spacing)
      doubtful.push_back(i);
  }
  if (!doubtful.empty()) {
    const Points known = result.surface_points(consistent, Eigen::indexing::all);
    const PointTree tree(known, context.stage(0, 0.5));
    std::vector<char> kept(doubtful.size());
    parallel_for(context.stage(0.5, 1), kept.size(), 1 << 10, [&](Index begin, Index end) {
      std::vector<Neighbour> found;
      for (Index k = begin; k < end; ++k)
        kept[k] = surrounded(result.surface_points.row(doubtful[k]), known, tree, found);
    });
    for (std::size_t k = 0; k < kept.size(); ++k)
      if (kept[k]) consistent.push_back(doubtful[k]);
    std::sort(consistent.begin(), consistent.end());
  }
  keep_pairs(result, consistent);
}

Result run_fixed_direction(const Cloud& cloud, const ParameterValues& values,
                           const Context& context) {
  Result result;
  result.method = "fixed_direction";
  const PrincipalFrame& frame = cloud.frame;
  const SurfacePoints work(frame.to_frame(cloud.points, context.stage(0, 0.05)),
                           values.integer("sample_size"), context.stage(0.05, 0.1));
  const Vector3 given = frame.axes.transpose() * values.vector("direction");
  const FieldEstimate found =
      find_height_field(work, given, result.statistics, context.stage(0.1, 0.7));
  if (found.nodes.rows() == 0) return result;

  // Not by transformed(): what a height field knows of its nodes takes time to make.
  Points nodes = frame.size * (found.nodes * frame.axes.transpose());
  nodes.rowwise() += frame.centroid.transpose();
  result.mirror =
      std::make_shared<HeightField>(frame.axes * found.direction, std::move(nodes), context);
  MirrorScore(cloud, context.stage(0.7, 0.8)).fill(result);
  add_pairs(result, cloud, values, context.stage(0.8, 0.9));
  result.surface_points = result.mirror->project(result.surface_points, context.stage(0.9, 0.95));
  const double working_share =
      static_cast<double>(work.size()) / static_cast<double>(cloud.points.size());
  keep_consistent_pairs(result, work.spacing * std::sqrt(working_share) * frame.size,
                        context.stage(0.95, 1));
  return result;
}

}  // namespace

MethodImplementation fixed_direction_method() {
  MethodImplementation method;
  method.name = "fixed_direction";
  method.title = "Curved mirror, fixed direction";
  method.summary =
      "Finds a curved mirror that maps all points along one direction, which is searched for "
      "unless given; the two sides may overlap.";
  method.parameters = {
      Parameter::direction(
          "direction",
          "Direction of mapping, known to within a degree; (0, 0, 0): it is searched for."),
      Parameter::integer("sample_size", 5000, 100, 100000, "points",
                         "Number of points used by the search."),
      pair_distance(),
  };
  method.minimum_points = 20;
  method.preprocessing.extract_boundary = false;
  method.run = run_fixed_direction;
  return method;
}

}  // namespace symsurf
