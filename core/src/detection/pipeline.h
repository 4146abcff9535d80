#pragma once

#include <optional>

#include "methods/registry.h"

namespace symsurf {

/// The way of a cloud through a method: validation, pre-processing, the method, mapping back.
/// `cloud`: what the caller gave, with its partition and seed. Nothing where the cloud is
/// distributed and a stage needs it in one process. Collective.
std::optional<Result> run_pipeline(const MethodImplementation& method,
                                   const ParameterValues& values, Cloud cloud,
                                   bool refuse_nonfinite, const Context& context);

}  // namespace symsurf
