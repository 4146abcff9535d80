#pragma once

#include <symsurf/analyses.h>

#include "point_group/coloured_surface.h"

namespace symsurf {

/// The subgroup of a shape's symmetries that keeps the colours of its surface. Elements of a finite
/// group are tried one by one. Of a continuous axis the turns of any angle are, then those by the
/// primes up to 31 and their powers; mirrors and half turns along it are turned to where the
/// colours agree best.
Symmetries coloured_group(const Symmetries& found, const ColouredSurface& surface,
                          const Context& context);

}  // namespace symsurf
