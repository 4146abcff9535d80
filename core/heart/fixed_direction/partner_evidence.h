#pragma once

#include "fixed_direction/mid_surface.h"

namespace symsurf {

/// Are there points whose partner lies just along the direction, more than chance puts there?
struct PartnerEvidence {
  Vector3 direction;        ///< moved to where most partners agree
  double significance = 0;  ///< standard deviations above chance
  double scatter = 0;       ///< of the partners across the direction, an axis
};

/// Tries scatters from a fraction of the spacing up to the surface's reach; at each, a mean shift
/// of the direction, freed of the pull of the evenly spread chance partners.
PartnerEvidence partner_evidence(const MidSurface& surface, const SurfacePoints& cloud,
                                 const Vector3& direction, const Context& context);

}  // namespace symsurf
