#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <cstdint>
#include <vector>

#include "cloud/surface_points.h"
#include "recurring/facets.h"

namespace symsurf {

/// The planar facets of a cloud's distinct points, by region growing: from where the surface is
/// flattest over neighbours near the plane whose normals agree. Great facets take points of lesser
/// ones that lie in their planes.
struct CloudFacets {
  CloudFacets(PointsView points, const Context& context);

  /// Squared, from x to the surface: the planes of facets with points about x, and tangent planes
  /// of points in none. Infinite where no point is near.
  double squared_distance(const Vector3& x) const;

  std::vector<std::int32_t> rows;  ///< of the distinct points in the cloud
  SurfacePoints surface;           ///< these
  std::vector<Index> facet;        ///< of each of them, -1: none
  std::vector<FacetPlane> planes;  ///< of the facets
  double noise = 0;                ///< standard deviation of the points
};

}  // namespace symsurf
