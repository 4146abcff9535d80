#pragma once

#include <vector>

#include "partial/surface_fit.h"
#include "partial/transformation_votes.h"

namespace symsurf {

struct PartialSearchOptions {
  VoteOptions votes;
  double minimum_size = 0;   // of a patch: share of the surface
  double minimum_score = 0;  // of a patch
  Index count = 0;           // most that are found
};

/// The partial symmetries of a surface (Mitra et al. 2006): patches that a map takes to other
/// places of the surface. The largest that fit well first.
std::vector<PatchPair> partial_patches(const ThinnedSurface& surface,
                                       const PartialSearchOptions& options, const Context& context);

}  // namespace symsurf
