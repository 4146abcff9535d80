#include <symsurf/context.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "analysis.h"
#include "fit/candidate.h"
#include "pairs/placement_search.h"
#include "sampled_shape.h"
#include "score/verdict.h"

namespace symsurf {

namespace {

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
  const auto digits = [](double x) { return to_string(Value(std::floor(1e4 * x) / 1e4)); };
  if (score < minimum_score)
    return "the best placement scores " + digits(score) + ", below the minimum_score of " +
           to_string(Value(minimum_score));
  if (evidence < PlacementSearch::least_evidence)
    return "the best placement scores " + digits(score) + ", but its evidence is " +
           digits(evidence) + ", below " + to_string(Value(PlacementSearch::least_evidence)) +
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
  const PlacedShape own(left.cloud, context.stage(0.2, 0.4)),
      other(right.cloud, context.stage(0.4, 0.6));
  const PlacementSearch search(own, other, true);
  const double spacing = other.coarse.spacing_of(given.other.points.size());
  const Eigen::Isometry3d map =
      exact(search.found(context.stage(0.6, 0.9)), given, left.cloud.frame, right.cloud.frame,
            spacing, context.stage(0.9, 0.9))
          .map;
  const Matrix4 matrix = between_frames(map, left.cloud.frame, right.cloud.frame);
  const MirrorFit fit = search.fit({map}, 1);
  const double evidence = search.evidence({map});
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
