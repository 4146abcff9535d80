#include "symmetries/partial/transformation_votes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/math.h"
#include "base/parallel.h"
#include "spatial/kd_tree.h"

namespace symsurf {

namespace {

using Invariants = KdTree<HeightSignature::length>;

// The least variation of a disc under turns, as a share of that of the waviest fifth of all.
constexpr double least_waviness = 0.25;

struct Disc {
  Index point;
  HeightSignature signature;
};

// Those that vary enough.
std::vector<Disc> described_discs(const ThinnedSurface& surface, double radius,
                                  const Context& context) {
  const SurfacePoints& all = surface.points();
  const DiscSamples samples(all, radius, context.stage(0, 0));
  std::vector<std::optional<HeightSignature>> signatures(all.size());
  constexpr Index grain = 64;
  parallel_for(context, all.size(), grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) signatures[i] = samples.about(all.point(i));
  });
  std::vector<Disc> discs;
  std::vector<double> waviness;
  for (Index i = 0; i < all.size(); ++i)
    if (signatures[i]) {
      discs.push_back({i, *signatures[i]});
      waviness.push_back(signatures[i]->waviness());
    }
  if (discs.empty()) return discs;
  constexpr double flat = 1e-6;  // of the radius: rounding
  const double least = std::max(flat, least_waviness * quantile(waviness, 0.8));
  std::erase_if(discs, [&](const Disc& disc) { return disc.signature.waviness() < least; });
  return discs;
}

}  // namespace

std::vector<TransformationVote> transformation_votes(const ThinnedSurface& surface,
                                                     const VoteOptions& options,
                                                     const Context& context) {
  constexpr Index alike = 8, most_asking = 3000;
  constexpr double greatest_residual = 0.5;
  std::vector<double> ratios{1};
  if (options.scales) ratios = {1, std::sqrt(0.5), std::sqrt(2.0), 0.5, 2};
  std::vector<std::vector<Disc>> discs;
  for (std::size_t k = 0; k < ratios.size(); ++k)
    discs.push_back(described_discs(
        surface, options.radius * ratios[k],
        context.stage(0.5 * static_cast<double>(k) / static_cast<double>(ratios.size()),
                      0.5 * static_cast<double>(k + 1) / static_cast<double>(ratios.size()))));
  std::vector<Disc> found;
  for (const auto& scale : discs) found.insert(found.end(), scale.begin(), scale.end());
  if (found.empty()) return {};
  std::vector<Invariants::Point> invariants;
  for (const Disc& disc : found) invariants.push_back(disc.signature.invariants());
  const Invariants tree(invariants, context);
  const Index asking = static_cast<Index>(discs.front().size());
  // Those along the whole list.
  const Index stride = (asking + most_asking - 1) / most_asking;
  const SurfacePoints& all = surface.points();

  constexpr Index grain = 64;
  std::vector<std::vector<TransformationVote>> parts((asking + grain - 1) / grain);
  parallel_for(context.stage(0.5, 1), asking, grain, [&](Index begin, Index end) {
    std::vector<TransformationVote>& votes = parts[begin / grain];
    std::vector<Neighbour> likest;
    for (Index k = begin; k < end; ++k) {
      const Disc& disc = found[k];
      if (k % stride != 0) continue;
      likest.clear();
      const auto wanted = static_cast<std::size_t>(alike);
      tree.search(invariants[k], infinity, [&](std::uint32_t other, double squared) {
        const double apart = (all.point(found[other].point) - all.point(disc.point)).norm();
        if (apart > disc.signature.radius)
          keep_best(likest, wanted, Neighbour{static_cast<Index>(other), squared});
        return likest.size() < wanted ? infinity
                                      : Invariants::at_most(likest.back().squared_distance);
      });
      for (const Neighbour& other : likest)
        for (const bool reflected : {false, true}) {
          if (!(reflected ? options.reflections : options.motions)) continue;
          const Disc& onto = found[other.index];
          const std::optional<DiscMatch> match =
              best_match(disc.signature, onto.signature, reflected);
          if (!match || match->residual > greatest_residual) continue;
          const double share = match->residual / greatest_residual, weight = 1 - share * share;
          const Eigen::Affine3d map =
              laid_onto(disc.signature, onto.signature, reflected, match->angle);
          votes.push_back({disc.point, onto.point, map, weight});
          votes.push_back({onto.point, disc.point, map.inverse(), weight});
        }
    }
  });
  std::vector<TransformationVote> votes;
  for (const auto& part : parts) votes.insert(votes.end(), part.begin(), part.end());
  return votes;
}

namespace {

using Space = KdTree<9>;  // a quaternion, a shift, the logarithm of a scale, and the parity
using Place = Space::Point;

// The widths of the kernel: radians, diagonals, and of the logarithm. Turns between discs are right
// to some 5 degrees, which moves what lies across the cloud by as much of a diagonal.
constexpr double turn_width = 0.2, shift_width = 0.05, scale_width = 0.15;

Place place_of(const Eigen::Affine3d& map) {
  const double determinant = map.linear().determinant();
  const double scale = std::cbrt(determinant);
  const Eigen::Quaterniond q(Matrix3(map.linear() / scale));  // of a reflection without inversion
  Place place;
  place << 2 / turn_width * q.coeffs(), map.translation() / shift_width,
      std::log(std::abs(scale)) / scale_width, determinant < 0 ? 2 : 0;
  return place;
}

}  // namespace

std::vector<VoteCluster> vote_clusters(const std::vector<TransformationVote>& votes,
                                       std::size_t most, const Context& context) {
  std::vector<VoteCluster> clusters;
  if (votes.empty()) return clusters;
  std::vector<Place> places;
  for (const TransformationVote& vote : votes) places.push_back(place_of(vote.map));
  const Space space(places, context);
  // Epanechnikov's kernel; visit(vote, its value).
  const auto around = [&](Index v, const auto& visit) {
    for (const double side : {1.0, -1.0}) {  // every turn has two quaternions
      Place at = places[v];
      at.head<4>() *= side;
      space.search(at, Space::at_most(1), [&](std::uint32_t k, double squared) {
        if (squared < 1) visit(static_cast<Index>(k), 1 - squared);
        return Space::at_most(1);
      });
    }
  };
  // Of an exactly symmetric shape half of all votes are one cluster: some are enough to find where
  // it is densest.
  constexpr Index grain = 64, most_looked_at = 6000;
  const Index count = static_cast<Index>(votes.size());
  const Index stride = (count + most_looked_at - 1) / most_looked_at;
  std::vector<std::pair<double, Index>> densities((count + stride - 1) / stride);
  parallel_for(context, static_cast<Index>(densities.size()), grain, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      auto& [density, v] = densities[k] = {0, k * stride};
      around(v, [&](Index other, double kernel) { density += kernel * votes[other].weight; });
    }
  });
  std::stable_sort(densities.begin(), densities.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<char> taken(votes.size(), 0);
  for (const auto& [density, v] : densities) {
    if (clusters.size() == most) break;
    if (taken[v]) continue;
    context.check();
    VoteCluster cluster{votes[v].map, {}};
    bool is_new = true;
    around(v, [&](Index other, double kernel) {
      is_new = is_new && !(taken[other] && kernel > 0.5);
      cluster.votes.push_back(other);
    });
    for (const Index other : cluster.votes) taken[other] = 1;
    if (is_new) clusters.push_back(std::move(cluster));
  }
  return clusters;
}

}  // namespace symsurf
