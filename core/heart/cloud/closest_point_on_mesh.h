#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace symsurf {

/// The point of a surface that is closest to a query; face -1: none.
struct ClosestPoint {
  Index face = -1;
  Vector3 point = Vector3::Zero();
  Vector3 weights = Vector3::Zero();  ///< barycentric coordinates, of the face's corners
  double squared_distance = std::numeric_limits<double>::infinity();
};

/// Exact closest points on triangles, by a tree of axis-aligned bounding boxes: each is divided at
/// the median of its triangles along the axis that their centroids extend along most. Ties go to
/// the lowest face. Faces may be degenerate and in any order; those with a corner that is not
/// finite are never found.
class ClosestPointOnMesh {
 public:
  /// The corners must be among the points. Copies what it is given. `uses`: of which faces; all
  /// without it.
  ClosestPointOnMesh(PointsView points, TrianglesView faces, const Context& context = {},
                     const std::function<bool(Index face)>& uses = {});

  /// The closest point whose squared distance is no more than `limit`; none to a query that is not
  /// finite.
  ClosestPoint operator()(const Vector3& query,
                          double limit = std::numeric_limits<double>::infinity()) const;

  /// The same among the faces whose normal makes at least this cosine with a unit direction.
  ClosestPoint facing(const Vector3& query, const Vector3& direction, double cosine,
                      double limit) const;

 private:
  struct Triangle {
    std::array<Vector3, 3> corner;  // from the middle of the mesh
    Index face;
  };
  struct Centroid {
    Vector3 place;
    Index face;
  };
  struct Building {
    PointsView points;
    TrianglesView faces;
    std::vector<Centroid>& centroids;
    const Context& context;
  };
  struct Node {
    Eigen::AlignedBox3d box;
    std::int32_t begin, end;   // its triangles
    std::int32_t second = -1;  // child; the first is the next node. -1: a leaf
  };
  struct Search;

  ClosestPoint found(Search search, double limit) const;
  std::int32_t build(const Building& of, std::int32_t begin, std::int32_t end);

  Vector3 origin_ = Vector3::Zero();
  double rounding_ = 0;  // of distances
  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace symsurf
