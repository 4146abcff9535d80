#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace symsurf {

/// What a surface is remeshed to.
struct Remeshing {
  double edge_length;          ///< of the triangles, input units
  double feature_angle = 180;  ///< degrees: edges between faces that meet at more stay as curves
  /// Leaves the boundary's vertices and edges as they are, and these vertices the first.
  bool keeps_boundary = false;
  /// Edges on the boundary that are a curve of their own, which others end at.
  /// No other edge joins two of their points.
  std::vector<std::pair<Index, Index>> marked = {};
  /// Moves a vertex back onto the surface; without it that is the closest point of the faces.
  std::function<Vector3(const Vector3&)> onto = {};
};

struct Remeshed {
  Points points;
  Triangles faces;
  std::vector<bool> marked;  ///< one a point: whether it lies on marked edges
};

/// Of so many equilateral triangles that cover an area.
inline double edge_length_of(double area, double triangles) {
  return std::sqrt(4 / std::sqrt(3) * area / triangles);
}

/// Triangles of one edge length for a manifold surface, by splits, collapses, flips and tangential
/// relaxation (Botsch and Kobbelt 2004). Vertices on boundaries and features slide along them;
/// where these end, meet or turn by more than the angle, they stay. Throws InvalidInput for faces
/// that a manifold has no room for.
Remeshed isotropic_remeshing(PointsView points, TrianglesView faces, const Remeshing& remeshing,
                             const Context& context);

}  // namespace symsurf
