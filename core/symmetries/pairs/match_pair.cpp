#include <symsurf/context.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "analysis.h"
#include "base/math.h"
#include "base/parallel.h"
#include "base/random.h"
#include "fit/candidate.h"
#include "fit/refinement.h"
#include "fit/shapes.h"
#include "sampled_shape.h"
#include "score/mirror_score.h"
#include "score/verdict.h"

namespace symsurf {

namespace {

using Placement = Candidate<UnitPlacement>;

// What the search looks at of a shape.
struct Side {
  Side(const Cloud& cloud, const Context& context)
      : coarse(cloud.patches(std::min(patches, cloud.points.size() / 2), context.stage(0, 0.4))),
        map(coarse),
        points(cloud, context),
        refinement(cloud, points, coarse,
                   cloud.finer_patches(std::min(patches, cloud.points.size() / 2),
                                       context.stage(0.4, 0.7))),
        score(cloud, context.stage(0.7, 1)),
        handedness(cloud.frame.axes.determinant()) {}

  static constexpr Index patches = 1000;
  const Surfels& coarse;
  SurfelMap map;
  NearestPoints points;
  Refinement refinement;
  MirrorScore score;
  double handedness;  // of the principal frame, 1 or -1
};

// Two surfels: from the first to the second, and how their normals stand to that.
struct Chord {
  Index from, to;
  double length;
  Vector3 direction;
  double lean_from, lean_to;  // cosines, of either sign

  bool operator<(const Chord& other) const { return length < other.length; }
};

class PairSearch {
 public:
  PairSearch(const Side& left, const Side& right)
      : left_(left), right_(right), determinant_(-left.handedness * right.handedness) {}

  /// The placement that scores most.
  UnitPlacement found(const Context& context) const;

  /// Of both shapes on each other.
  MirrorFit fit(const UnitPlacement& placement, Index stride) const;

 private:
  static Chord chord(const Surfels& surfels, Index from, Index to);
  static std::vector<Index> flat_ones(const Surfels& surfels);
  std::vector<UnitPlacement> hypotheses(const Context& context) const;
  void add_laid_onto(const Chord& a, const Chord& b, std::vector<UnitPlacement>& all) const;

  const Side &left_, &right_;
  double determinant_;  // of maps between the principal frames, which may be left-handed
};

Chord PairSearch::chord(const Surfels& surfels, Index from, Index to) {
  const Vector3 way = surfels[to].position - surfels[from].position;
  const double length = way.norm();
  const Vector3 direction = way / std::max(length, 1e-12);
  return {from,
          to,
          length,
          direction,
          std::abs(direction.dot(surfels[from].normal)),
          std::abs(direction.dot(surfels[to].normal))};
}

// About so many.
std::vector<Index> PairSearch::flat_ones(const Surfels& surfels) {
  constexpr double least_flatness = 0.3;
  constexpr Index wanted = 250;
  std::vector<Index> flat;
  for (Index i = 0; i < surfels.size(); i += std::max<Index>(1, surfels.size() / wanted))
    if (surfels[i].flatness > least_flatness) flat.push_back(i);
  return flat;
}

// Reflections that lay two surfels on two others, normals included (Drost et al., Model globally,
// match locally, 2010); normals have either sign.
void PairSearch::add_laid_onto(const Chord& a, const Chord& b,
                               std::vector<UnitPlacement>& all) const {
  constexpr double alike = 0.88;  // cosine, 28 degrees
  const Surfels &from = left_.coarse, &onto = right_.coarse;
  const auto frame = [](const Chord& chord, const Vector3& normal) {
    Matrix3 axes;
    axes.col(0) = chord.direction;
    axes.col(1) = (normal - normal.dot(chord.direction) * chord.direction).stableNormalized();
    axes.col(2) = axes.col(0).cross(axes.col(1));
    return axes;
  };
  // The normal that leans less says more.
  const bool by_from = a.lean_from + b.lean_from < a.lean_to + b.lean_to;
  const Matrix3 own = frame(a, from[by_from ? a.from : a.to].normal);
  const Matrix3 other = frame(b, onto[by_from ? b.from : b.to].normal);
  for (const double sign : {1.0, -1.0}) {
    const Matrix3 turn =
        other * Vector3(1, sign, determinant_ * sign).asDiagonal() * own.transpose();
    if (std::abs((turn * from[a.from].normal).dot(onto[b.from].normal)) < alike ||
        std::abs((turn * from[a.to].normal).dot(onto[b.to].normal)) < alike)
      continue;
    all.push_back({map_taking(turn, (from[a.from].position + from[a.to].position) / 2,
                              (onto[b.from].position + onto[b.to].position) / 2)});
  }
}

std::vector<UnitPlacement> PairSearch::hypotheses(const Context& context) const {
  constexpr double shortest = 0.15;  // diagonals
  constexpr double leaning = 0.25;
  constexpr int tried = 400;
  constexpr std::size_t enough = 40'000;
  std::vector<UnitPlacement> all;
  // The principal frames: enough for whole shapes.
  for (const Vector3& signs :
       {Vector3(1, 1, 1), Vector3(1, -1, -1), Vector3(-1, 1, -1), Vector3(-1, -1, 1)})
    all.push_back({Eigen::Isometry3d(Matrix3((determinant_ * signs).asDiagonal()))});
  const std::vector<Index> own = flat_ones(left_.coarse), others = flat_ones(right_.coarse);
  if (own.size() < 2) return all;
  std::vector<Chord> chords;
  for (const Index i : others)
    for (const Index j : others)
      if (const Chord b = chord(right_.coarse, i, j); b.length > shortest) chords.push_back(b);
  std::stable_sort(chords.begin(), chords.end());
  const double off = (left_.coarse.spacing() + right_.coarse.spacing()) / 2;
  Random random(0);
  for (int trial = 0; trial < tried && all.size() < enough; ++trial) {
    context.check();
    const Chord a =
        chord(left_.coarse, own[random.below(std::ssize(own))], own[random.below(std::ssize(own))]);
    if (a.length < shortest) continue;
    const auto less = [](const Chord& b, double length) { return b.length < length; };
    for (auto b = std::lower_bound(chords.begin(), chords.end(), a.length - off, less);
         b != chords.end() && b->length < a.length + off; ++b)
      if (std::abs(a.lean_from - b->lean_from) < leaning &&
          std::abs(a.lean_to - b->lean_to) < leaning)
        add_laid_onto(a, *b, all);
  }
  return all;
}

MirrorFit PairSearch::fit(const UnitPlacement& placement, Index stride) const {
  const MirrorFit there = left_.score.fit(placement.map, right_.score, stride),
                  back = right_.score.fit(placement.map.inverse(), left_.score, stride);
  return {(there.share + back.share) / 2, (there.missing + back.missing) / 2,
          (there.exact + back.exact) / 2, (there.deviation + back.deviation) / 2};
}

UnitPlacement PairSearch::found(const Context& context) const {
  constexpr Index rough = 40, close = 4;
  constexpr double apart = 0.03;  // diagonals
  const std::vector<UnitPlacement> all = hypotheses(context.stage(0, 0.3));
  std::vector<Placement> candidates = best_of(all, left_.coarse, right_.map, rough, context);
  if (candidates.empty()) candidates.push_back({all.front()});
  for (Placement& candidate : candidates) {
    context.check();
    candidate = refined_on_surfels(left_.coarse, right_.map, candidate, 0.06, 0.015, 8, 3);
    candidate.support = fit(candidate.shape, 9).share;
  }
  suppress_non_maxima(left_.coarse, candidates, apart, close);
  for (Placement& candidate : candidates) {
    context.check();
    candidate.shape = left_.refinement.refined(candidate.shape, right_.refinement);
    candidate.support = fit(candidate.shape, 3).share;
  }
  sort_best_first(candidates);
  return candidates.front().shape;
}

Matrix4 in_input_units(const Eigen::Isometry3d& map, const PrincipalFrame& from,
                       const PrincipalFrame& onto) {
  const Matrix3 linear = onto.axes * map.linear() * from.axes.transpose();
  return map_taking(linear, from.centroid, onto.from_frame(map.translation())).matrix();
}

// To rounding where points of both are each other's images, as the vertices of two meshes may be.
UnitPlacement exact(const UnitPlacement& start, const ColouredCloud& given,
                    const PrincipalFrame& own, const PrincipalFrame& other, double spacing,
                    const Context& context) {
  constexpr Index wanted = 1000;
  std::vector<Vector3> positions;
  const Index count = given.points.size();
  for (Index i = 0; i < count; i += std::max<Index>(1, count / wanted))
    positions.push_back(own.to_frame(given.points[i]));
  return fitted_to_exact_pairs(start, positions, NearestPoints(given.other, context), other,
                               spacing)
      .value_or(start);
}

void require_like_sizes(double left, double right) {
  // A third of its points missing made a bone 2.7 times as large as the other.
  constexpr double most = 4;
  if (std::max(left, right) > most * std::min(left, right))
    throw InvalidInput(
        "the shapes are " + to_string(Value(left)) + " and " + to_string(Value(right)) +
        " large, by the diagonals of their boxes along the "
        "principal axes; allowed is one at most " +
        to_string(Value(most)) + " times as large as the other: both must be in one unit");
}

// Empty: they are a pair.
std::string reason_against(double score, double evidence, double minimum_score) {
  // In "make accuracy" right placements have 0.42 at least (a third of both bones missing), shapes
  // that are no pair 0.38 at most, except bones that differ by little more than the noise.
  constexpr double least_evidence = 0.4;
  const auto digits = [](double x) { return to_string(Value(std::floor(1e4 * x) / 1e4)); };
  if (score < minimum_score)
    return "the best placement scores " + digits(score) + ", below the minimum_score of " +
           to_string(Value(minimum_score));
  if (evidence < least_evidence)
    return "the best placement scores " + digits(score) + ", but its evidence is " +
           digits(evidence) + ", below " + to_string(Value(least_evidence)) +
           ": placements beside it fit nearly as well";
  return {};
}

void run_match_pair(const ColouredCloud& given, const ParameterValues& values,
                    const Context& context, AnalysisResult& result) {
  SampledShape left(given, context.stage(0, 0.1)), right(given.other, context.stage(0.1, 0.2));
  const double own_size = left.cloud.frame.size, other_size = right.cloud.frame.size;
  const double size = std::max(own_size, other_size);
  require_like_sizes(own_size, other_size);
  for (Cloud* cloud : {&left.cloud, &right.cloud}) cloud->frame = cloud->frame.with_size(size);
  const Side own(left.cloud, context.stage(0.2, 0.4)), other(right.cloud, context.stage(0.4, 0.6));
  const PairSearch search(own, other);
  const double spacing = other.coarse.spacing_of(given.other.points.size());
  const Eigen::Isometry3d map =
      exact(search.found(context.stage(0.6, 0.9)), given, left.cloud.frame, right.cloud.frame,
            spacing, context.stage(0.9, 0.9))
          .map;
  const Matrix4 matrix = in_input_units(map, left.cloud.frame, right.cloud.frame);
  const MirrorFit fit = search.fit({map}, 1);
  const double evidence =
      (own.score.evidence(map, other.score) + other.score.evidence(map.inverse(), own.score)) / 2;
  const std::string reason = reason_against(fit.share, evidence, values.real("minimum_score"));
  result.transformations.push_back(
      {kind_of(matrix, given.frame.centroid, single_rounding, single_rounding * size),
       matrix,
       fit.share,
       {},
       {}});
  result.statistics = {{"score", fit.share},
                       {"verdict", std::string(reason.empty() ? "found" : "none")},
                       {"reason", reason},
                       {"missing_share", fit.missing},
                       {"contradicted_share", std::max(0.0, 1 - fit.share - fit.missing)},
                       {"deviation", fit.deviation},
                       {"evidence", evidence}};
  const PointTree& tree = given.other.tree(context.stage(0.9, 1));
  const double reach = farthest_residual * size;
  Eigen::VectorXd index(given.points.size()), distance(given.points.size());
  for (Index i = 0; i < given.points.size(); ++i) {
    const Neighbour partner =
        tree.nearest((matrix * given.points[i].homogeneous()).head<3>(), reach * reach);
    index[i] = static_cast<double>(partner.index);
    distance[i] = partner.index < 0 ? NAN : std::sqrt(partner.squared_distance);
  }
  result.arrays = {{"index", index}, {"distance", distance}};
}

}  // namespace

AnalysisImplementation match_pair_analysis() {
  AnalysisImplementation analysis;
  analysis.name = "match_pair";
  analysis.title = "Pair matching";
  analysis.summary =
      "Finds the reflection and rigid placement that lays one of two shapes, such as a left and a "
      "right bone, onto the other.";
  analysis.parameters = {
      Parameter::real("minimum_score", usual_minimum_score, 0, 1, "",
                      "Minimum score of a pair: share of both shapes that lies on the other.")};
  analysis.arrays = {
      {"index", ParameterType::Integer, 1,
       "Index of the point of the other shape that lies nearest to the image of the point, -1 if "
       "none lies within 3 % of the diagonal.",
       false, false, false, true},
      {"distance", ParameterType::Real, 1,
       "Distance of the image from that point, input units; NaN without one."}};
  analysis.shown = "distance";
  analysis.minimum_points = SampledShape::minimum_points;
  analysis.takes_other = analysis.finds_transforms = true;
  analysis.run = run_match_pair;
  return analysis;
}

}  // namespace symsurf
