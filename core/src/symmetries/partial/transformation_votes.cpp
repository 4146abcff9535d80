#include "symmetries/partial/transformation_votes.h"

#include <algorithm>
#include <cmath>

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
  std::vector<std::optional<HeightSignature>> signatures(all.size());
  constexpr Index grain = 64;
  parallel_for(context, all.size(), grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) signatures[i] = described(all, i, radius);
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

}  // namespace symsurf
