#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include "operations/counterparts.h"

namespace symsurf {

/// The homologous points of a shape by non-rigid registration with its image.
/// `images`: of the points, NaN where there are none. Without faces the points are a cloud, whose
/// surface is that of cloud_laplacian().
HomologousPoints homologous_points(PointsView points, TrianglesView faces, PointsView images,
                                   const Context& context);

}  // namespace symsurf
