#pragma once

#include <symsurf/parameter.h>
#include <symsurf/result.h>

#include <functional>

#include "cloud/cloud.h"
#include "methods/thesis/separation.h"

namespace symsurf {

/// The frame of Algorithms 1 and 2: separates the cloud by every plane of the half sphere and keeps
/// the one with the highest s = ln(d + 1) + exp(-e) (3.4), e from `projection_error` (input units
/// squared), d the clearance (input units); equal scores: the first. Its pairs are the result, in
/// the order of their points; residuals are distances of partners from their lines. The tree is
/// that of the points.
Result best_separation(const Cloud& cloud, const PointTree& tree, Index steps,
                       const std::function<double(const Separation&)>& projection_error,
                       const Context& context);

/// The parameter that sets how many directions these algorithms try.
Parameter direction_steps();

}  // namespace symsurf
