#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <utility>
#include <vector>

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

}  // namespace symsurf
