#pragma once

#include <symsurf/context.h>
#include <symsurf/detect.h>
#include <symsurf/mirrors.h>
#include <symsurf/points.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "cloud/principal_frame.h"

namespace symsurf {

class PointTree;
class Surfels;

/// A point cloud or mesh on its way to a method. Its parts are made when they are first asked for,
/// once, safely between threads, and shared by copies of the cloud.
struct Cloud {
  Cloud();
  explicit Cloud(PointsView points, PointsView normals = {});

  /// Other points: the parts are made anew.
  void set_points(PointsView points, PointsView normals);

  /// The k-d tree of the points.
  const PointTree& tree(const Context& context) const;

  /// Frees the tree of so many points that it takes the memory which others need: references to it
  /// end. The next who asks for it gets another.
  void release_tree() const;

  /// About so many patches.
  const Surfels& patches(Index about, const Context& context) const;

  /// About four times as many, clutter left out as there.
  const Surfels& finer_patches(Index about, const Context& context) const;

  /// About so many of the points, drawn at random: images over the frame's planes, as those of
  /// exact mirrors are, together. The cloud itself where it has no more.
  const Cloud& thinned(Index about, const Context& context) const;

  PointsView points;
  PointsView normals;   ///< empty: none given; otherwise one line direction a point, sign ignored
  TrianglesView faces;  ///< between the vertices where there are any, else the points
  std::shared_ptr<const Cloud> vertices;  ///< of the mesh, where the points are samples of it
  std::vector<Plane> vertex_planes;       ///< that map the vertices onto themselves, all of them
  PointsView footprint;  ///< what a mirror is drawn over, where that is more than the points
  std::uint64_t seed = 0;
  double tolerance = usual_tolerance;  ///< of the score, in diagonals
  double diagonal = 0;                 ///< of the axis-aligned bounding box
  PrincipalFrame frame;

 private:
  struct Parts;
  std::shared_ptr<Parts> parts_;
};

/// Sets diagonal and frame, and checks what every method relies on: at least minimum_points points
/// and no more than can be numbered, all finite, not all on one line; normals, where given, one a
/// point, finite and not zero. Throws InvalidInput.
void validate(Cloud& cloud, Index minimum_points, const Context& context);

/// These rows; none where there are none to choose from, as of a cloud without normals.
template <typename Integer>
Points chosen_rows(PointsView all, const std::vector<Integer>& rows) {
  if (all.empty()) return Points(0, 3);
  return all.matrix()(rows, Eigen::indexing::all);
}

/// A validated cloud.
Cloud checked_cloud(PointsView points, PointsView normals, Index minimum_points,
                    const Context& context);

bool are_finite(PointsView rows);

/// Throws InvalidInput naming the first of the rows that is not finite, as "point 3" where `what`
/// is "point". `first`: the number of the first row.
void require_finite(PointsView rows, const char* what, Index first = 0);

/// Throws InvalidInput for no points, or naming the first that is not finite.
void require_points(PointsView points);

/// Throws InvalidInput naming the first finite point with a coordinate beyond 1e50: squares would
/// overflow. `first`: the number of the first row.
void require_coordinates(PointsView points, Index first = 0);

/// Throws InvalidInput where the finite rows extend over more than 1e50 along an axis: fourth
/// powers of lengths would overflow. `what`: "points".
void require_extent(PointsView rows, const char* what);

/// Throws InvalidInput for fewer points than needed.
void require_count(Index given, Index needed);

/// Throws InvalidInput unless there are no normals, or one a point, and those of finite points are
/// finite and not zero. `first`: the number of the first row.
void require_normals(PointsView points, PointsView normals, Index first = 0);

/// Whether one process can number so many points.
bool is_numerable(Index own);

/// Throws InvalidInput where it cannot.
void require_numerable(Index own);

/// Of the bounding box of at least one point, in input units.
inline double diagonal_of(PointsView points) {
  return (points.matrix().colwise().maxCoeff() - points.matrix().colwise().minCoeff()).norm();
}

/// Points far from each other (Gonzalez 1985): the first is the farthest from the centroid, each
/// next one the farthest from those before it. All where there are no more than `count`.
std::vector<Index> farthest_points(PointsView points, Index count, const Context& context);

/// The lowest and the highest point along x, y and z: six, or none of no points.
std::vector<Vector3> extreme_points(PointsView points);

/// What mirrors and axes are drawn over: every k-th point of the cloud, and the extreme ones.
Points footprint_of(const Cloud& cloud);

/// Sets what the result's mirrors are drawn over.
void set_footprint(Result& result, const Cloud& cloud);

/// Sets a footprint that is there already.
void set_footprint(Result& result, Points footprint);

/// The distinct points of a cloud, in the order of their first appearance.
struct DistinctPoints {
  std::vector<std::int32_t> first;   ///< of each, the first point of the cloud that equals it
  std::vector<std::int32_t> number;  ///< of each point of the cloud, which of these it is
};

DistinctPoints distinct_points(PointsView points, const Context& context);

/// Whether more than one in twenty points are copies of others: exact of few distinct points, an
/// estimate of many.
bool has_many_duplicates(PointsView points, const Context& context);

}  // namespace symsurf
