#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <memory>
#include <vector>

namespace symsurf {

/// Throws InvalidInput naming the first face with a corner that is none of so many points.
void require_corners(TrianglesView faces, Index points);

/// Whether a face names a corner twice.
inline bool is_degenerate(const Index* face) {
  return face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
}

/// The area of the faces, in square input units.
double surface_area(PointsView points, TrianglesView faces);

/// A triangle mesh in double precision with the neighbourhoods of its vertices (OpenMesh). Vertex i
/// is point i, used by a face or not. Faces that a manifold with one winding has no room for are
/// kept aside: areas, normals, neighbours and the boundary take them into account, loops do not.
/// Copies what it is given. Takes time by the square of the number of faces around one vertex.
class TriangleMesh {
 public:
  enum class Weight { Area, Angle };

  /// Throws InvalidInput naming the first face with a corner that is none of the points.
  TriangleMesh(PointsView points, TrianglesView faces, const Context& context = {});
  ~TriangleMesh();
  TriangleMesh(TriangleMesh&&) noexcept;
  TriangleMesh& operator=(TriangleMesh&&) noexcept;

  Index vertices() const;
  Index faces() const;  ///< all that were given
  Vector3 point(Index vertex) const;

  /// Why faces are kept aside: they name a corner twice; repeat an earlier face, in either winding;
  /// are a third at an edge, wound against their neighbours, or meet others in a vertex that is
  /// closed.
  struct Refused {
    Index degenerate = 0, repeated = 0, nonmanifold = 0;
    Index total() const { return degenerate + repeated + nonmanifold; }
  };
  const Refused& refused() const { return refused_; }

  /// The faces that are not kept aside, all wound alike where they meet, in the order given.
  Triangles manifold_faces() const;

  /// One a vertex: a third of the area of the faces around it. Their sum is the area of all.
  std::vector<double> vertex_areas() const;

  /// Unit normals, one a face that was given; zero for those without an area.
  Points face_normals() const;

  /// Unit normals, one a vertex: the mean over the faces around it (Thürmer and Wüthrich, 1998, for
  /// the weight by angle). Faces kept aside are turned as their neighbours are. Zero where no face
  /// with an area is. `positions`: of the vertices, where they are not those of the points.
  Points vertex_normals(Weight weight = Weight::Angle, PointsView positions = {}) const;

  /// Vertices joined to this one by an edge, in ascending order.
  std::vector<Index> neighbours(Index vertex) const;

  /// One a vertex: whether it ends an edge that one face alone has.
  std::vector<bool> is_boundary() const;

  /// The closed boundaries of the faces that are not kept aside: each begins with its lowest vertex
  /// and follows the winding of the hole. In the order of their first vertices.
  std::vector<std::vector<Index>> boundary_loops() const;

 private:
  struct Connectivity;

  template <typename Visit>
  void for_each_face(const Visit& visit) const;

  std::unique_ptr<Connectivity> mesh_;
  Refused refused_;
};

}  // namespace symsurf
