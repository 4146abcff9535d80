#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include "surface_graph.h"

namespace symsurf {

/// Non-rigid registration of a triangulated surface onto its mirror image: of each vertex where its
/// homologous point of the image lies, from the vertex. Of all smooth
/// displacements onto the image that of least bending energy, as semilandmarks slide (Bookstein
/// 1997; Gunz and Mitteroecker 2013), with mean curvature to resist the sliding.
/// Lengths are in diagonals of the points; there must be faces, and they finite with their images.
Points registered_displacements(PointsView points, PointsView images, TrianglesView faces,
                                const SurfaceGraph& graph, const Context& context);

}  // namespace symsurf
