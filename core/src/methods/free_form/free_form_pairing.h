#pragma once

#include <symsurf/result.h>

#include "methods/free_form/free_form_refinement.h"

namespace symsurf::perpendicular {

/// Fills the result's pairs over its mirror: partners no farther from the images than the surface's
/// own, never the point itself and, where partners are exact, only those that agree. Where they are
/// not, the surface points are the midpoints' feet on the mirror.
void add_pairs(Result& result, const Cloud& cloud, const SearchCloud& searched,
               const GrownSurface& surface, double pair_distance, const Context& context);

}  // namespace symsurf::perpendicular
