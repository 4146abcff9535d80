#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <vector>

#include "surface_graph.h"

namespace symsurf {

/// Of each vertex the one that mirrors it, where both sides have one triangulation: of the maps of
/// each connected part onto itself or another the one that is nearest to a registration; -1 where
/// faces differ, and for parts that have no map of at least half of their vertices.
/// Lengths are in diagonals; `displacements`: of the registration.
std::vector<Index> vertex_table(PointsView points, PointsView images, const SurfaceGraph& graph,
                                const Points& displacements, const Context& context);

}  // namespace symsurf
