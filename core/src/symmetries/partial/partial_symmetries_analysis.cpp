#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/math.h"
#include "base/parallel.h"
#include "symmetries/analysis_registry.h"
#include "symmetries/partial/patch_growth.h"
#include "symmetries/partial/transformation_votes.h"

namespace symsurf {

namespace {

// Of a patch: with less it slides or turns on its own surface, as flat and round ones and edges do.
constexpr double least_hold = 0.04;

// The points of the discs whose votes a cluster holds.
std::vector<Index> seeds_of(const VoteCluster& cluster,
                            const std::vector<TransformationVote>& votes,
                            const SurfacePoints& points, double radius) {
  std::vector<Index> seeds;
  for (const Index v : cluster.votes)
    points.tree.within(points.point(votes[v].from), radius,
                       [&](Index i, double) { seeds.push_back(i); });
  std::sort(seeds.begin(), seeds.end());
  seeds.erase(std::unique(seeds.begin(), seeds.end()), seeds.end());
  return seeds;
}

// Whether a map hardly moves most of the patch, as the identity does.
bool hardly_moves(const PatchPair& pair, const SurfacePoints& points, double least) {
  std::vector<double> moved;
  for (const Index i : pair.from)
    moved.push_back((pair.map * points.point(i) - points.point(i)).norm());
  return median(std::move(moved)) < least;
}

double size_and_score(const PatchPair& pair) {
  return static_cast<double>(pair.from.size()) * pair.hold * pair.score;
}

struct PartialSearchOptions {
  VoteOptions votes;
  double minimum_size = 0.03;  // of a patch: share of the surface
  double minimum_score = 0.8;
  Index count = 20;  // most that are found
};

// The partial symmetries of a surface (Mitra et al. 2006): the largest patches that a map takes to
// other places of the surface, the best first.
std::vector<PatchPair> partial_search(const ThinnedSurface& surface,
                                      const PartialSearchOptions& options, const Context& context) {
  const auto least =
      static_cast<Index>(std::ceil(options.minimum_size * static_cast<double>(surface.size())));
  const std::vector<TransformationVote> votes =
      transformation_votes(surface, options.votes, context.stage(0, 0.4));
  if (getenv("DBGT")) { double tx,ty,tz; sscanf(getenv("DBGT"),"%lf,%lf,%lf",&tx,&ty,&tz); int c=0; double w=0; for (auto& v : votes) { Eigen::Matrix4d M=surface.in_input_units(v.map); if ((M.topLeftCorner<3,3>()-Eigen::Matrix3d::Identity()).norm()<0.3 && (M.topRightCorner<3,1>()-Eigen::Vector3d(tx,ty,tz)).norm()<0.4) {++c; w+=v.weight; fprintf(stderr,"   vote %.2f %.2f %.2f w %.2f R %.2f\n",M(0,3),M(1,3),M(2,3),v.weight,(M.topLeftCorner<3,3>()-Eigen::Matrix3d::Identity()).norm());}} fprintf(stderr,"votes near truth %d weight %.2f tol %.4f spacing %.4f radius %.4f\n",c,w,surface.tolerance(),surface.spacing(),options.votes.radius); }
  const std::size_t most_clusters = 3 * static_cast<std::size_t>(options.count);
  const std::vector<VoteCluster> clusters =
      vote_clusters(votes, most_clusters, context.stage(0.4, 0.6));
  const PatchGrowth growth(surface, options.votes.scales);
  std::vector<std::optional<PatchPair>> grown(clusters.size());
  parallel_for(context.stage(0.6, 0.95), static_cast<Index>(clusters.size()), 1,
               [&](Index begin, Index end) {
                 for (Index k = begin; k < end; ++k) {
                   const std::vector<Index> seeds =
                       seeds_of(clusters[k], votes, surface.points(), options.votes.radius / 2);
                   grown[k] = growth.grown(clusters[k].map, seeds, least, context);
                 }
               });
  std::vector<PatchPair> found;
  if (getenv("DBG")) for (auto& pair : grown) if (pair) { Eigen::Matrix4d M = surface.in_input_units(pair->map); fprintf(stderr, "  grown %zu score %.3f hold %.3f  t %.3f %.3f %.3f R %.2f %.2f %.2f moves %d\n", pair->from.size(), pair->score, pair->hold, M(0,3), M(1,3), M(2,3), M(0,0), M(1,1), M(2,2), !hardly_moves(*pair, surface.points(), options.votes.radius)); }
  for (std::optional<PatchPair>& pair : grown)
    if (pair && pair->score >= options.minimum_score && pair->hold > least_hold &&
        !hardly_moves(*pair, surface.points(), options.votes.radius))
      found.push_back(std::move(*pair));
  std::stable_sort(found.begin(), found.end(), [](const PatchPair& a, const PatchPair& b) {
    return size_and_score(a) > size_and_score(b);
  });
  const double same = surface.spacing();
  const auto alike = [&](const PatchPair& a, const PatchPair& b) {
    double straight = 0, back = 0;
    const Eigen::Affine3d inverse = b.map.inverse();
    for (const Index i : a.from) {
      const Vector3 x = surface.points().point(i);
      straight = std::max(straight, (a.map * x - b.map * x).norm());
      back = std::max(back, (a.map * x - inverse * x).norm());
    }
    return std::min(straight, back) < same;
  };
  suppress_non_maxima(found, static_cast<std::size_t>(options.count), alike);
  return found;
}

// Radians and diagonals: what a fitted map may miss the symmetry by that it is named after.
constexpr double same_angle = 0.02, same_length = 0.01;

void run_partial_symmetries(const ColouredCloud& cloud, const ParameterValues& values,
                            const Context& context, AnalysisResult& result) {
  const ThinnedSurface surface(cloud, values.integer("points"), context.stage(0, 0.2));
  PartialSearchOptions options;
  options.votes.reflections = values.boolean("reflections");
  options.votes.motions = values.boolean("motions");
  options.votes.scales = values.boolean("scales");
  options.votes.radius = std::sqrt(values.real("disc") * surface.area() / std::numbers::pi);
  options.minimum_size = values.real("minimum_size");
  options.minimum_score = values.real("minimum_score");
  options.count = values.integer("count");
  const std::vector<PatchPair> found = partial_search(surface, options, context.stage(0.2, 1));

  const Index count = cloud.points.size();
  Eigen::VectorXd best = Eigen::VectorXd::Constant(count, -1), side = best;
  for (const PatchPair& pair : found) {
    Transformation transformation;
    transformation.matrix = surface.in_input_units(pair.map);
    transformation.kind = kind_of(transformation.matrix, cloud.frame.centroid, same_angle,
                                  same_length * cloud.diagonal);
    transformation.score = pair.score;
    transformation.from = surface.near(pair.from);
    transformation.onto = surface.near(pair.onto);
    // Of a coarse mesh, whose surface is sampled, a patch may lie between the points.
    if (transformation.from.empty() || transformation.onto.empty()) continue;
    const auto number = static_cast<double>(result.transformations.size());
    const auto mark = [&](const std::vector<Index>& patch, double which) {
      for (const Index i : patch)
        if (best[i] < 0) {
          best[i] = number;
          side[i] = which;
        }
    };
    mark(transformation.from, 0);
    mark(transformation.onto, 1);
    result.transformations.push_back(std::move(transformation));
  }
  result.arrays = {{"transformation", best}, {"side", side}};
  result.statistics["transformations"] = static_cast<Index>(result.transformations.size());
  result.statistics["diagonal"] = cloud.diagonal;
}

}  // namespace

AnalysisImplementation partial_symmetries_analysis() {
  AnalysisImplementation analysis;
  analysis.name = "partial_symmetries";
  analysis.title = "Partial symmetries";
  analysis.summary =
      "Finds parts of a shape that a reflection, motion or similarity maps onto other parts, by "
      "pairs of like points that vote for it (Mitra et al. 2006).";
  analysis.parameters = {
      Parameter::boolean("reflections", true, "Whether maps may reflect."),
      Parameter::boolean("motions", true, "Whether maps may be rotations, translations, screws."),
      Parameter::boolean("scales", false, "Whether maps may scale, from a half to double."),
      Parameter::real("minimum_size", 0.03, 0.001, 1, "",
                      "The least share of the surface that a patch covers."),
      Parameter::real("minimum_score", 0.8, 0, 1, "",
                      "How close to the surface the images of a patch must come."),
      Parameter::integer("count", 20, 1, 1000, "", "The most transformations that are found."),
      Parameter::real("disc", 0.015, 0.001, 0.1, "",
                      "The share of the surface in the disc that a point is known by."),
      Parameter::integer("points", 10000, 500, 200000, "points",
                         "What a larger cloud is thinned to."),
  };
  analysis.arrays = {
      {"transformation", ParameterType::Integer, 1,
       "The first transformation with the point in a patch, -1: none."},
      {"side", ParameterType::Integer, 1,
       "0: in the patch that is mapped, 1: in the one it falls on, -1: in none."},
  };
  analysis.shown = "transformation";
  analysis.minimum_points = 10;
  analysis.finds_transforms = true;
  analysis.run = run_partial_symmetries;
  return analysis;
}

}  // namespace symsurf
