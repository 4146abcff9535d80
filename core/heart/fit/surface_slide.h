#pragma once

#include "fit/refinement.h"

namespace symsurf {

/// Where noise or a dent hides which points are partners, surfaces alone distinguish mirrors that
/// slide along them, and a fit creeps: slides the mirror over the plane of its loosest changes, for
/// as long as another position explains clearly more. Without it one of ten dented balls loses its
/// cylinder. Then it is fitted closely, and to rounding where partners are exact.
template <typename Shape>
Candidate<Shape> polished(const Candidate<Shape>& candidate, const Fit& fit,
                          const Refinement& refinement);

}  // namespace symsurf
