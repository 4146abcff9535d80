#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

namespace symsurf {

struct ManifoldSurface {
  Points points;
  Triangles faces;
};

/// An oriented manifold of the faces of a mesh, corners at the same position taken for one. Faces
/// that name a corner twice or repeat another are left out; connected ones are wound alike, as most
/// of them are. Where three and more meet in an edge, or two that cannot be wound alike, each has
/// an edge of its own. The same for any order of the faces.
ManifoldSurface manifold_surface(PointsView points, TrianglesView faces, const Context& context);

}  // namespace symsurf
