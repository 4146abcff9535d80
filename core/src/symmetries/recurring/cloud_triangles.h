#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

namespace symsurf {

/// A manifold of triangles through the points of a cloud.
struct CloudTriangles {
  Triangles faces;
  double spacing = 0;  ///< of the points, input units
};

/// Those of the points' Delaunay stars that most of their corners have, first; then holes are
/// filled (Gopi, Krishnan and Silva 2000).
CloudTriangles cloud_triangles(PointsView points, const Context& context);

}  // namespace symsurf
