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

/// A mirror in input units, and the surface it comes from.
struct Found {
  std::shared_ptr<Mirror> mirror;
  GrownSurface surface;
};

/// A mirror of the search's frame in input units.
std::shared_ptr<Mirror> in_input_units(const Mirror& mirror, const SearchCloud& searched);

/// Ranks the first of the mirrors, as many as "max_candidates" allows, and pairs the points over
/// the best; without mirrors the result stays as it is. Partners are no farther from the images
/// than the surface's own, never the point itself and, where partners are exact, only those that
/// agree. Where they are not, the surface points are the midpoints' feet on the mirror.
void fill(Result& result, const Cloud& cloud, const SearchCloud& searched,
          const std::vector<Found>& found, const ParameterValues& values, const Context& context);

/// The parameters of the methods that search in this way.
std::vector<Parameter> search_parameters();

}  // namespace symsurf::perpendicular
