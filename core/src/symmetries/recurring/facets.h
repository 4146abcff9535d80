#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <utility>
#include <vector>

namespace symsurf {

/// Moments of a piece of surface up to the second, about the origin.
struct SurfaceMoments {
  double area = 0;
  Vector3 sum = Vector3::Zero();
  Matrix3 products = Matrix3::Zero();

  static SurfaceMoments of_triangle(const Vector3& a, const Vector3& b, const Vector3& c);

  SurfaceMoments& operator+=(const SurfaceMoments& other);
  Vector3 centroid() const { return sum / area; }
  Matrix3 scatter() const { return products - sum * sum.transpose() / area; }
};

/// The plane through a piece of surface, by principal components.
struct FacetPlane {
  Vector3 centroid = Vector3::Zero(), normal = Vector3::Zero();
  double width = 0;  ///< standard deviation along the narrower of the directions in the plane
};
FacetPlane plane_of(const SurfaceMoments& moments);

using Adjacency = std::vector<std::pair<Index, Index>>;

/// Pieces of surface merged into nearly flat facets, the flattest pairs first (Garland, Willmott
/// and Heckbert 2001): the number of the facet of each piece. The root mean square distance from
/// the common plane that the lesser of two adds stays within `deviation`; facets of less than
/// `least_area` go to a neighbour however they lie. Facets of `full` pieces take no more.
std::vector<Index> merged_facets(const std::vector<SurfaceMoments>& pieces,
                                 const Adjacency& adjacent, double deviation, double least_area,
                                 Index full, const Context& context);

/// Standard deviation of the noise of the points of a surface, from quadrics fitted to the flattest
/// patches. `corners`: the points of each piece. 0 where no patch has enough of them.
double noise_of_pieces(PointsView points, const std::vector<std::vector<Index>>& corners,
                       const std::vector<SurfaceMoments>& pieces, const Adjacency& adjacent,
                       const Context& context);

}  // namespace symsurf
