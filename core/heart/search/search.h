#pragma once

#include <symsurf/detect.h>
#include <symsurf/parameter.h>

#include <vector>

#include "search/free_form_refinement.h"

namespace symsurf::perpendicular {

/// The surfaces over which a cloud is mirrored perpendicularly, best first, and the points that
/// were searched.
struct Search {
  SearchCloud cloud;
  std::vector<GrownSurface> surfaces;
};

Search search(const Cloud& cloud, Index sample_size, const Context& context);

/// Whether points have exact partners. Those inside a volumetric cloud then have as many as those
/// of its boundary.
bool has_exact_partners(const Cloud& cloud, const ParameterValues& values, const Context& context);

/// Of methods that search in this way.
constexpr Index least_points = 12;

}  // namespace symsurf::perpendicular
