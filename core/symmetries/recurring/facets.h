#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "cloud/surface_points.h"

namespace symsurf {

/// Diagonals: what single precision makes of coordinates.
inline constexpr double coordinate_rounding = 1e-7;

/// Standard deviations of the noise that a piece may lie off the plane of a facet that takes it.
inline constexpr double in_plane = 2.5;

/// Of a facet's area: what it must keep where larger ones take from it, and growth by which its
/// plane is fitted again.
inline constexpr double least_left = 0.5, refitted = 1.2;

/// Moments up to the second, about the origin, of pieces of a surface.
struct SurfaceMoments {
  double area = 0, pieces = 0;
  Vector3 sum = Vector3::Zero();
  Matrix3 products = Matrix3::Zero();

  /// Of a point of area 1.
  static SurfaceMoments of_point(const Vector3& x);
  static SurfaceMoments of_triangle(const Vector3& a, const Vector3& b, const Vector3& c);

  SurfaceMoments& operator+=(const SurfaceMoments& other);
  Vector3 centroid() const { return sum / area; }
  Matrix3 scatter() const { return products - sum * sum.transpose() / area; }
};

/// The plane through a piece of surface, by principal components.
struct FacetPlane {
  Vector3 centroid = Vector3::Zero(), normal = Vector3::Zero();
  /// Radians that noise turns it by, for each unit of the noise.
  double turned = 0;
};
FacetPlane plane_of(const SurfaceMoments& moments);

/// Of each group the pieces in it, ascending; -1: in none.
std::vector<std::vector<Index>> members_of(const std::vector<Index>& group);

using Adjacency = std::vector<std::pair<Index, Index>>;

/// Pieces of a surface: their moments, the points that each has, and which touch.
struct SurfacePieces {
  std::vector<SurfaceMoments> moments;
  std::vector<std::vector<Index>> points;
  Adjacency adjacent;
};

/// Pieces of surface merged into nearly flat facets, the flattest pairs first (Garland, Willmott
/// and Heckbert 2001): the number of the facet of each piece. `noise`: standard deviation of the
/// points, which tells what is flat.
std::vector<Index> facets_of(PointsView points, const SurfacePieces& pieces, double noise,
                             const Context& context);

/// Standard deviation of the noise of the points of a surface, from quadrics fitted to the flattest
/// patches. 0 where no patch has enough points.
double noise_of(PointsView points, const SurfacePieces& pieces, const Context& context);

/// Great facets take pieces of lesser ones, or of none, that lie in their planes and go on from
/// theirs. What has lost much is taken apart. `facet`: of each piece the number of its facet, -1:
/// none. Pieces has
///   SurfaceMoments moments(Index piece) const,
///   bool is_in(const FacetPlane&, Index piece) const,
///   void for_each_next(Index piece, visit) const, which calls visit(next).
template <typename Pieces>
std::vector<Index> great_facets(const Pieces& pieces, std::vector<Index> facet,
                                const Context& context) {
  const std::vector<std::vector<Index>> members = members_of(facet);
  std::vector<double> area(members.size(), 0);
  for (std::size_t own = 0; own < members.size(); ++own)
    for (const Index piece : members[own]) area[own] += pieces.moments(piece).area;
  std::vector<Index> order(members.size()), rank(members.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return area[a] > area[b]; });
  for (std::size_t k = 0; k < order.size(); ++k) rank[order[k]] = static_cast<Index>(k);
  for (const Index own : order) {
    std::vector<Index> open;
    SurfaceMoments held;
    for (const Index piece : members[own])
      if (facet[piece] == own) {
        open.push_back(piece);
        held += pieces.moments(piece);
      }
    if (held.area < least_left * area[own] || !(held.area > 0)) {
      for (const Index piece : open) facet[piece] = -1;
      continue;
    }
    FacetPlane plane = plane_of(held);
    double fitted = held.area;
    constexpr std::size_t stretch = 4096;  // pieces between questions whether to go on
    for (std::size_t k = 0; k < open.size(); ++k) {
      if (k % stretch == 0) context.check();
      pieces.for_each_next(open[k], [&](Index next) {
        if (facet[next] == own || (facet[next] >= 0 && rank[facet[next]] < rank[own]) ||
            !pieces.is_in(plane, next))
          return;
        facet[next] = own;
        open.push_back(next);
        held += pieces.moments(next);
        if (held.area > refitted * fitted) {
          plane = plane_of(held);
          fitted = held.area;
        }
      });
    }
  }
  return facet;
}

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
