#pragma once

#include <symsurf/parameter.h>
#include <symsurf/result.h>

#include "cloud/cloud.h"
#include "methods/free_form/parametric_search.h"

namespace symsurf::perpendicular {

/// Finds free-form mirrors, fits one of the model's kind to the best of them and keeps the one that
/// explains most of the cloud.
Result find_parametric(const std::string& method,
                       std::unique_ptr<Model> (*model)(const GrownSurface&), const Cloud& cloud,
                       const ParameterValues& values, const Context& context);

/// The parameters of all methods that search as "perpendicular" does.
std::vector<Parameter> search_parameters();

}  // namespace symsurf::perpendicular
