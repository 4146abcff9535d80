#pragma once

#include <vector>

#include "methods/free_form/free_form_refinement.h"

namespace symsurf::perpendicular {

/// Joins surfaces that are pieces of one mirror, parted by a crease, a hole or a gap: each explains
/// points that the others do not. Gives whole mirrors, the one that explains most first
/// (planes behind curved mirrors that explain about as much).
std::vector<GrownSurface> assemble(const SearchCloud& cloud, std::vector<GrownSurface> surfaces,
                                   const Context& context);

}  // namespace symsurf::perpendicular
