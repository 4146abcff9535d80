#pragma once

#include "methods/parametric/refinement.h"
#include "methods/sphere/sphere_candidates.h"

namespace symsurf {

/// Fits a quadratic to what positions over the same plane explain, near the sphere, and goes where
/// it is highest: many positions together tell more than each, which noise moves up and down. The
/// candidate as it was where it explains no more there.
SphereCandidate settled_on_surfaces(const SphereCandidate& candidate,
                                    const ParametricRefinement& refinement);

}  // namespace symsurf
