#pragma once

#include <symsurf/context.h>
#include <symsurf/points_view.h>

#include <string_view>

namespace symsurf {

/// Unit normals, one a point, from each point's `neighbours` nearest (itself among them; equal
/// distances: the lowest index). "pca": the direction of least variance, its largest component
/// positive. "regression": z = b0 + b1 x + b2 y by least squares (minimum norm where it is rank
/// deficient), normal (-b1, -b2, 1): thesis 3.4.1; poor on vertical patches.
/// Throws InvalidInput for fewer points than neighbours, InvalidParameter for fewer than 3
/// neighbours or an unknown name.
Points estimate_normals(PointsView points, Index neighbours = 10, std::string_view method = "pca",
                        const Context& context = {});

}  // namespace symsurf
