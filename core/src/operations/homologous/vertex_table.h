#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <vector>

#include "operations/homologous/surface_graph.h"

namespace symsurf {

/// Of each vertex the one that mirrors it, where both sides have one triangulation: the
/// automorphism of the edges that is nearest to a registration. -1 where it does not hold; empty
/// where it holds for too few vertices to be no chance. `displacements`: of the registration.
std::vector<Index> vertex_table(PointsView points, PointsView images, const SurfaceGraph& graph,
                                const Points& displacements, const Context& context);

}  // namespace symsurf
