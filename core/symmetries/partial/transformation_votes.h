#pragma once

#include <vector>

#include "partial/height_signature.h"
#include "thinned_surface.h"

namespace symsurf {

/// A pair of like points and the map between them: mass in the space of transformations.
struct TransformationVote {
  Index from = -1, onto = -1;
  Eigen::Affine3d map = Eigen::Affine3d::Identity();
  double weight = 0;
};

struct VoteOptions {
  bool reflections = true, motions = true, scales = false;
  double radius = 0;  ///< of the discs, diagonals
};

/// Both ways of every pair of points that are among the most alike of the surface.
std::vector<TransformationVote> transformation_votes(const ThinnedSurface& surface,
                                                     const VoteOptions& options,
                                                     const Context& context);

/// Votes around one in whose neighbourhood they are densest.
struct VoteCluster {
  Eigen::Affine3d map = Eigen::Affine3d::Identity();  ///< of that one
  std::vector<Index> votes;
};

/// Where votes are densest in the space of turns, shifts and scales (Mitra et al. 2006), of
/// reflections and of motions, the densest first.
std::vector<VoteCluster> vote_clusters(const std::vector<TransformationVote>& votes,
                                       std::size_t most, const Context& context);

}  // namespace symsurf
