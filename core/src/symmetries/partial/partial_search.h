#pragma once

#include <vector>

#include "symmetries/partial/transformation_votes.h"
#include "symmetries/pieces/patch_growth.h"

namespace symsurf {

struct PartialSearchOptions {
  VoteOptions votes;
  double minimum_size = 0.03;  ///< of a patch: share of the surface
  double minimum_score = 0.8;
  Index count = 20;  ///< most that are found
};

/// The partial symmetries of a surface (Mitra et al. 2006): the largest patches that a map takes to
/// other places of the surface, the best first.
std::vector<PatchPair> partial_search(const ThinnedSurface& surface,
                                      const PartialSearchOptions& options, const Context& context);

}  // namespace symsurf
