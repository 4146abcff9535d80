#pragma once

#include <vector>

#include "search/free_form_refinement.h"

namespace symsurf::perpendicular {

/// Adds the planes that map the whole cloud onto itself, of which a thinned cloud does not have the
/// partners. False: there are none.
bool lay_exact_planes(const Cloud& cloud, const SearchCloud& search,
                      std::vector<GrownSurface>& surfaces, const Context& context);

/// Adds the surfaces that the best mirror planes and the principal planes of the cloud become when
/// they are bent until they mirror it. Unlike surfaces that grow they need no partners that stand
/// close to the images, and take hold of what both sides have in common by and by; but they have to
/// be within reach of a plane.
void bend_planes(const Cloud& cloud, const SearchCloud& search, std::vector<GrownSurface>& surfaces,
                 const Context& context);

}  // namespace symsurf::perpendicular
