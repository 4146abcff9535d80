#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include "cloud/laplacian.h"

namespace symsurf {

/// The Laplacian of a surface that points lie on, with the triangles of each point and two
/// neighbours, wound alike where normals can be carried from point to point.
struct CloudLaplacian : Laplacian {
  Triangles triangles;
};

/// By finite volumes: each point's Voronoi cell among its neighbours in its tangent plane, as the
/// cotangents of a local Delaunay triangulation give (Luo, Safa and Wang 2009; Sharp and Crane
/// 2020). Weights are made symmetric by their mean. Points must be distinct.
CloudLaplacian cloud_laplacian(PointsView points, const Context& context);

}  // namespace symsurf
