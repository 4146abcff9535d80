#include "symmetries/partial/partial_search.h"

#include <algorithm>
#include <cmath>

#include "base/math.h"
#include "base/parallel.h"

namespace symsurf {

namespace {

// Below, a patch slides or turns on its own surface, as flat and round ones do. Bodies that hold
// least have four times as much.
constexpr double least_hold = 1e-3;

// Those of the largest connected part; of equal ones the first.
std::vector<Index> largest_part(const std::vector<Index>& seeds, const SurfacePoints& points) {
  std::vector<char> waiting(points.size(), 0);
  for (const Index i : seeds) waiting[i] = 1;
  std::vector<Index> largest;
  for (const Index seed : seeds) {
    if (!waiting[seed]) continue;
    waiting[seed] = 0;
    std::vector<Index> part{seed};
    for (std::size_t k = 0; k < part.size(); ++k)
      for (int n = 0; n < SurfacePoints::ring; ++n) {
        const Index other = points.neighbours(part[k], n);
        if (!waiting[other]) continue;
        waiting[other] = 0;
        part.push_back(other);
      }
    if (part.size() > largest.size()) largest = std::move(part);
  }
  std::sort(largest.begin(), largest.end());
  return largest;
}

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
  return largest_part(seeds, points);
}

// Whether a map hardly moves most of the patch, as the identity does.
bool hardly_moves(const PatchPair& pair, const SurfacePoints& points, double least) {
  std::vector<double> moved;
  for (const Index i : pair.from)
    moved.push_back((pair.map * points.point(i) - points.point(i)).norm());
  return median(std::move(moved)) < least;
}

double size_and_score(const PatchPair& pair) {
  return static_cast<double>(pair.from.size()) * pair.score;
}

}  // namespace

std::vector<PatchPair> partial_search(const ThinnedSurface& surface,
                                      const PartialSearchOptions& options, const Context& context) {
  const auto least =
      static_cast<Index>(std::ceil(options.minimum_size * static_cast<double>(surface.size())));
  const std::vector<TransformationVote> votes =
      transformation_votes(surface, options.votes, context.stage(0, 0.4));
  constexpr std::size_t most_clusters = 40;
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

}  // namespace symsurf
