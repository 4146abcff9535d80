#pragma once

#include <symsurf/mirrors.h>

#include <optional>

#include "methods/free_form/free_form_refinement.h"

namespace symsurf::perpendicular {

/// The quadric nearest to a surface, matched to the cloud and fitted to its pairs again and again
/// by analytic derivatives (Levenberg-Marquardt, Tukey's weights). The surface gets its pairs and
/// support; none when the surface has too few points or nothing fits.
std::optional<Quadric> fitted_quadric(const SearchCloud& cloud, GrownSurface& surface);

}  // namespace symsurf::perpendicular
