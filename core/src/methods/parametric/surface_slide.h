#pragma once

#include <vector>

#include "methods/parametric/refinement.h"

namespace symsurf {

/// Where noise or a dent hides which points are partners, surfaces alone distinguish mirrors that
/// slide along them, and a fit creeps: slides the mirror over the plane of its loosest changes, for
/// as long as another position explains clearly more. Without it one of ten dented balls loses its
/// cylinder.
template <typename Shape>
Candidate<Shape> slid_along_surfaces(Candidate<Shape> candidate,
                                     const Refinement& refinement);

}  // namespace symsurf
