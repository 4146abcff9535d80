#pragma once

#include "methods/parametric/refinement.h"
#include "methods/sphere/sphere_candidates.h"

namespace symsurf {

/// Moves a sphere to the maximum of a quadratic fitted to the support of spheres around it: the fit
/// averages the noise of each. The candidate as it was where its support is no less.
SphereCandidate at_support_maximum(const SphereCandidate& candidate,
                                   const ParametricRefinement& refinement);

}  // namespace symsurf
