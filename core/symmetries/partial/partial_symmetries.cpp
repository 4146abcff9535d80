#include "partial/partial_symmetries.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>

#include "analysis.h"
#include "base/math.h"
#include "base/parallel.h"

namespace symsurf {

namespace {

// Of a patch: with less it slides on its own surface, as flat and round ones and edges do. Over a
// chair and six scanned facades slides and flips have 0.035 and less, true maps more but for those
// over two storeys, 0.01 to 0.03.
constexpr double least_hold = 0.04;
constexpr std::size_t most_clusters = 150, most_composed = 100;  // that are grown
constexpr std::size_t composed = 24;                             // the best, with each other

double size_and_score(const PatchPair& pair) {
  return static_cast<double>(pair.from.size()) * pair.score;
}

// Every so many of the points, about 100.
std::vector<Index> sample_of(const std::vector<Index>& points) {
  constexpr std::size_t enough = 100;
  std::vector<Index> few;
  for (std::size_t k = 0; k < points.size(); k += 1 + points.size() / enough)
    few.push_back(points[k]);
  return few;
}

class PartialSearch {
 public:
  PartialSearch(const ThinnedSurface& surface, const PartialSearchOptions& options)
      : surface_(surface),
        options_(options),
        fit_(surface, options.votes.scales),
        growth_(fit_),
        least_(static_cast<Index>(
            std::ceil(options.minimum_size * static_cast<double>(surface.size())))) {}

  std::vector<PatchPair> found(const Context& context) const {
    std::vector<PatchPair> starts = voted(context.stage(0, 0.4));
    std::vector<PatchPair> whole =
        component_pairs(surface_, options_, least_, context.stage(0.4, 0.6));
    std::move(whole.begin(), whole.end(), std::back_inserter(starts));
    std::vector<PatchPair> found = grown(starts, context.stage(0.6, 0.8));
    best_of(found);
    for (int round = 0; round < 2; ++round) {
      std::vector<PatchPair> more =
          grown(compositions(found), context.stage(0.8 + 0.1 * round, 0.9 + 0.1 * round));
      std::move(more.begin(), more.end(), std::back_inserter(found));
      best_of(found);
    }
    if (std::ssize(found) > options_.count) found.resize(options_.count);
    return found;
  }

 private:
  // Where votes are dense, with the points of their discs.
  std::vector<PatchPair> voted(const Context& context) const {
    const SurfacePoints& points = surface_.points();
    const std::vector<TransformationVote> votes =
        transformation_votes(surface_, options_.votes, context.stage(0, 0.7));
    std::vector<PatchPair> candidates;
    for (const VoteCluster& cluster : vote_clusters(votes, most_clusters, context.stage(0.7, 1))) {
      PatchPair candidate;
      candidate.map = cluster.map;
      for (const Index v : cluster.votes)
        points.tree.within(points.point(votes[v].from), options_.votes.radius / 2,
                           [&](Index i, double) { candidate.from.push_back(i); });
      std::sort(candidate.from.begin(), candidate.from.end());
      candidate.from.erase(std::unique(candidate.from.begin(), candidate.from.end()),
                           candidate.from.end());
      candidates.push_back(std::move(candidate));
    }
    return candidates;
  }

  // One map after another, where both hold: from window to window to window.
  std::vector<PatchPair> compositions(const std::vector<PatchPair>& found) const {
    std::vector<PatchPair> all;
    const std::size_t count = std::min(composed, found.size());
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = 0; b < count; ++b)
        for (int ways = 0; ways < 4; ++ways) {
          const bool back = ways & 1, then_back = ways & 2;
          PatchPair pair;
          pair.map = (then_back ? found[b].map.inverse() : found[b].map) *
                     (back ? found[a].map.inverse() : found[a].map);
          if (!(pair.map.linear().determinant() < 0 ? options_.votes.reflections
                                                    : options_.votes.motions))
            continue;
          const std::vector<Index>& patch = back ? found[a].onto : found[a].from;
          const std::vector<Index> few = sample_of(patch);
          for (const Index i : few)
            if (fit_.landing(pair.map, i, 2 * surface_.tolerance()).agrees) pair.from.push_back(i);
          // So many points it stands for each of.
          pair.score = static_cast<double>(patch.size()) / static_cast<double>(few.size());
          if (size_and_score(pair) < static_cast<double>(least_) / 2 || hardly_moves(pair))
            continue;
          all.push_back(std::move(pair));
        }
    best_of(all);
    std::erase_if(all, [&](const PatchPair& pair) {
      return std::any_of(found.begin(), found.end(),
                         [&](const PatchPair& other) { return are_alike(pair, other); });
    });
    if (all.size() > most_composed) all.resize(most_composed);
    return all;
  }

  std::vector<PatchPair> grown(const std::vector<PatchPair>& candidates,
                               const Context& context) const {
    const auto count = static_cast<Index>(candidates.size());
    std::vector<std::optional<PatchPair>> pairs(count);
    parallel_for(context, count, 1, [&](Index begin, Index end) {
      for (Index k = begin; k < end; ++k)
        pairs[k] = growth_.grown(candidates[k].map, candidates[k].from, least_, context);
    });
    std::vector<PatchPair> found;
    for (Index k = 0; k < count; ++k) {
      std::optional<PatchPair>& pair = pairs[k];
      if (pair && pair->score >= options_.minimum_score &&
          std::max(pair->hold, candidates[k].hold) > least_hold && !hardly_moves(*pair))
        found.push_back(std::move(*pair));
    }
    return found;
  }

  // Whether a map hardly moves most of the patch, as the identity does.
  bool hardly_moves(const PatchPair& pair) const {
    std::vector<double> moved;
    for (const Index i : pair.from) {
      const Vector3 x = surface_.points().point(i);
      moved.push_back((pair.map * x - x).norm());
    }
    return moved.empty() || median(std::move(moved)) < options_.votes.radius;
  }

  // The same map, or the one back.
  bool are_alike(const PatchPair& a, const PatchPair& b) const {
    double straight = 0, back = 0;
    const Eigen::Affine3d inverse = b.map.inverse();
    for (const Index i : sample_of(a.from)) {
      const Vector3 x = surface_.points().point(i);
      straight = std::max(straight, (a.map * x - b.map * x).norm());
      back = std::max(back, (a.map * x - inverse * x).norm());
    }
    return std::min(straight, back) < surface_.spacing();
  }

  void best_of(std::vector<PatchPair>& pairs) const {
    std::stable_sort(pairs.begin(), pairs.end(), [](const PatchPair& a, const PatchPair& b) {
      return size_and_score(a) > size_and_score(b);
    });
    suppress_non_maxima(pairs, pairs.size(),
                        [&](const PatchPair& a, const PatchPair& b) { return are_alike(a, b); });
  }

  const ThinnedSurface& surface_;
  const PartialSearchOptions& options_;
  SurfaceFit fit_;
  PatchGrowth growth_;
  Index least_;  // points of a patch
};

}  // namespace

std::vector<PatchPair> partial_patches(const ThinnedSurface& surface,
                                       const PartialSearchOptions& options,
                                       const Context& context) {
  return PartialSearch(surface, options).found(context);
}

namespace {

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
  const std::vector<PatchPair> found = partial_patches(surface, options, context.stage(0.2, 1));

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
      "votes of pairs of similar points (Mitra et al. 2006).";
  analysis.parameters = {
      Parameter::boolean("reflections", true, "Allow reflections."),
      Parameter::boolean("motions", true, "Allow rotations, translations and screws."),
      Parameter::boolean("scales", false, "Allow scaling, by 0.5 to 2."),
      Parameter::real("minimum_size", 0.03, 0.001, 1, "",
                      "Minimum share of the surface that a patch covers."),
      Parameter::real("minimum_score", 0.8, 0, 1, "",
                      "Minimum score of a transformation: how closely the image of its patch "
                      "matches the surface."),
      Parameter::integer("count", 100, 1, 1000, "", "Maximum number of transformations to find."),
      Parameter::real("disc", 0.015, 0.001, 0.1, "",
                      "Share of the surface in the disc around a point by which it is described."),
      Parameter::integer("points", 10000, 500, 200000, "points",
                         "Number of points to which a larger cloud is downsampled."),
  };
  analysis.arrays = {
      {"transformation", ParameterType::Integer, 1,
       "Index of the first transformation with the point in a patch, -1: none."},
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
