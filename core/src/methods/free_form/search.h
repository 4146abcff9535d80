#pragma once

#include <symsurf/result.h>

#include <vector>

#include "methods/free_form/free_form_refinement.h"

namespace symsurf::perpendicular {

/// The sheets over which a cloud is mirrored perpendicularly, best first, and the points that were
/// searched.
struct Search {
  SearchCloud cloud;
  std::vector<Sheet> sheets;
};

Search search(const Cloud& cloud, Index sample_size, const Context& context);

/// run(cloud, values, context), on the skin alone where the cloud fills bodies: unless points have
/// exact partners, of which those inside have as many.
Result run_on_what_tells(const Cloud& cloud, const ParameterValues& values, const Context& context,
                         Result (*run)(const Cloud&, const ParameterValues&, const Context&));

/// Of methods that search in this way.
constexpr Index least_points = 12;

}  // namespace symsurf::perpendicular
