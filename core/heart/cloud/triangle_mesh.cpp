#include "cloud/triangle_mesh.h"

#include <symsurf/context.h>

#include <Eigen/Geometry>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "base/parallel.h"

namespace symsurf {

namespace {

using OpenTriMesh = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;
using Vertex = OpenMesh::VertexHandle;
using Halfedge = OpenMesh::HalfedgeHandle;
using Corners = std::array<Index, 3>;

Vertex handle(Index vertex) { return Vertex(static_cast<int>(vertex)); }

// Whether add_face() has room for the face. It would write to stderr, which a library must not, and
// leave the mesh as it is: these are its own conditions.
bool has_room(const OpenTriMesh& mesh, const Corners& face) {
  std::array<Halfedge, 3> edge;
  for (int c = 0; c < 3; ++c) {
    if (!mesh.is_boundary(handle(face[c]))) return false;
    edge[c] = mesh.find_halfedge(handle(face[c]), handle(face[(c + 1) % 3]));
    if (edge[c].is_valid() && !mesh.is_boundary(edge[c])) return false;
  }
  // Where two edges are there already and something lies between them, it must go elsewhere.
  for (int c = 0; c < 3; ++c) {
    const Halfedge to = edge[c], from = edge[(c + 1) % 3];
    if (!to.is_valid() || !from.is_valid() || mesh.next_halfedge_handle(to) == from) continue;
    Halfedge gap = mesh.opposite_halfedge_handle(from);
    do {
      gap = mesh.opposite_halfedge_handle(mesh.next_halfedge_handle(gap));
    } while (!mesh.is_boundary(gap));
    if (gap == to) return false;
  }
  return true;
}

bool has_face(const OpenTriMesh& mesh, const Corners& face) {
  const Halfedge edge = mesh.find_halfedge(handle(face[0]), handle(face[1]));
  if (!edge.is_valid()) return false;
  const auto faces_third = [&](Halfedge side) {
    return !mesh.is_boundary(side) &&
           mesh.to_vertex_handle(mesh.next_halfedge_handle(side)) == handle(face[2]);
  };
  return faces_third(edge) || faces_third(mesh.opposite_halfedge_handle(edge));
}

}  // namespace

struct TriangleMesh::Connectivity {
  struct Aside {
    Index number;
    Corners corner;
  };
  using Edge = std::pair<Index, Index>;  // lower vertex first

  OpenTriMesh mesh;
  std::vector<Index> number;  // of a face of the mesh among those given
  std::vector<Aside> aside;
  std::map<Edge, int> faces_aside;          // how many at an edge; repeated faces do not count
  std::map<Index, std::set<Index>> joined;  // vertices, by faces aside

  Vector3 point(Index vertex) const { return Vector3(mesh.point(handle(vertex)).data()); }

  void keep_aside(Index f, const Corners& corner, bool counts) {
    aside.push_back({f, corner});
    for (int c = 0; c < 3; ++c) {
      const Index a = corner[c], b = corner[(c + 1) % 3];
      if (a == b) continue;
      joined[a].insert(b);
      joined[b].insert(a);
      if (counts) ++faces_aside[std::minmax(a, b)];
    }
  }

  // Whether more neighbours of a face aside have another winding than the same.
  bool is_against_neighbours(const Corners& corner) const {
    int against = 0;
    for (int c = 0; c < 3; ++c) {
      const Halfedge edge = mesh.find_halfedge(handle(corner[c]), handle(corner[(c + 1) % 3]));
      if (!edge.is_valid()) continue;
      against += !mesh.is_boundary(edge);
      against -= !mesh.is_boundary(mesh.opposite_halfedge_handle(edge));
    }
    return against > 0;
  }

  // visit(vertex, vertex) for each edge that one face alone has.
  template <typename Visit>
  void for_each_boundary_edge(const Visit& visit) const {
    for (const auto edge : mesh.edges()) {
      const Index a = edge.v0().idx(), b = edge.v1().idx();
      if (edge.is_boundary() && !faces_aside.contains(std::minmax(a, b))) visit(a, b);
    }
    for (const auto& [edge, faces] : faces_aside)
      if (faces == 1 && !mesh.find_halfedge(handle(edge.first), handle(edge.second)).is_valid())
        visit(edge.first, edge.second);
  }
};

TriangleMesh::TriangleMesh(PointsView points, TrianglesView faces, const Context& context)
    : mesh_(std::make_unique<Connectivity>()) {
  require_corners(faces, points.size());
  OpenTriMesh& mesh = mesh_->mesh;
  mesh.reserve(points.size(), points.size() + faces.size(), faces.size());
  for (Index i = 0; i < points.size(); ++i)
    mesh.add_vertex({points[i].x(), points[i].y(), points[i].z()});
  std::set<Corners> nonmanifold;
  interruptible_for(context, faces.size(), [&](Index f) {
    context.check();  // at a vertex with many faces one takes long
    const Corners face{faces[f][0], faces[f][1], faces[f][2]};
    if (is_degenerate(faces[f])) {
      ++refused_.degenerate;
      mesh_->keep_aside(f, face, false);
      return;
    }
    Corners ordered = face;
    std::sort(ordered.begin(), ordered.end());
    if (has_face(mesh, face) || nonmanifold.contains(ordered)) {
      ++refused_.repeated;
      mesh_->keep_aside(f, face, false);
    } else if (has_room(mesh, face) &&
               mesh.add_face(handle(face[0]), handle(face[1]), handle(face[2])).is_valid()) {
      mesh_->number.push_back(f);
    } else {
      ++refused_.nonmanifold;
      nonmanifold.insert(ordered);
      mesh_->keep_aside(f, face, true);
    }
  });
}

TriangleMesh::~TriangleMesh() = default;
TriangleMesh::TriangleMesh(TriangleMesh&&) noexcept = default;
TriangleMesh& TriangleMesh::operator=(TriangleMesh&&) noexcept = default;

Index TriangleMesh::vertices() const { return static_cast<Index>(mesh_->mesh.n_vertices()); }

Index TriangleMesh::faces() const {
  return static_cast<Index>(mesh_->number.size() + mesh_->aside.size());
}

Vector3 TriangleMesh::point(Index vertex) const { return mesh_->point(vertex); }

// visit(number, corners, whether it is kept aside): those kept aside last.
template <typename Visit>
void TriangleMesh::for_each_face(const Visit& visit) const {
  for (const auto face : mesh_->mesh.faces()) {
    const auto edge = face.halfedge();
    visit(mesh_->number[face.idx()],
          Corners{edge.from().idx(), edge.to().idx(), edge.next().to().idx()}, false);
  }
  for (const auto& [number, corner] : mesh_->aside) visit(number, corner, true);
}

Triangles TriangleMesh::manifold_faces() const {
  Triangles kept(static_cast<Index>(mesh_->number.size()), 3);
  Index row = 0;
  for_each_face([&](Index, const Corners& corner, bool is_aside) {
    if (!is_aside) kept.row(row++) << corner[0], corner[1], corner[2];
  });
  return kept;
}

std::vector<double> TriangleMesh::vertex_areas() const {
  std::vector<double> areas(vertices(), 0);
  for_each_face([&](Index, const Corners& corner, bool) {
    const Vector3 x = point(corner[0]);
    const double area = (point(corner[1]) - x).cross(point(corner[2]) - x).norm() / 2;
    for (const Index i : corner) areas[i] += area / 3;
  });
  return areas;
}

Points TriangleMesh::face_normals() const {
  Points normals(faces(), 3);
  for_each_face([&](Index number, const Corners& corner, bool) {
    const Vector3 x = point(corner[0]);
    normals.row(number) = (point(corner[1]) - x).cross(point(corner[2]) - x).stableNormalized();
  });
  return normals;
}

Points TriangleMesh::vertex_normals(Weight weight, PointsView positions) const {
  const auto at = [&](Index vertex) {
    return positions.empty() ? point(vertex) : positions[vertex];
  };
  Points normals = Points::Zero(vertices(), 3);
  for_each_face([&](Index, const Corners& corner, bool is_aside) {
    const std::array<Vector3, 3> x{at(corner[0]), at(corner[1]), at(corner[2])};
    const Vector3 area = (x[1] - x[0]).cross(x[2] - x[0]);
    const double twice_area = area.norm();
    const int winding = is_aside && mesh_->is_against_neighbours(corner) ? -1 : 1;
    const Vector3 normal = winding * area.stableNormalized();
    for (int c = 0; c < 3; ++c) {
      const Vector3 one = x[(c + 1) % 3] - x[c], other = x[(c + 2) % 3] - x[c];
      const double share =
          weight == Weight::Angle ? std::atan2(twice_area, one.dot(other)) : twice_area;
      normals.row(corner[c]) += share * normal.transpose();
    }
  });
  for (Index i = 0; i < normals.rows(); ++i) normals.row(i) = normals.row(i).stableNormalized();
  return normals;
}

std::vector<Index> TriangleMesh::neighbours(Index vertex) const {
  std::vector<Index> found;
  for (const auto neighbour : mesh_->mesh.vv_range(handle(vertex)))
    found.push_back(neighbour.idx());
  const auto more = mesh_->joined.find(vertex);
  if (more != mesh_->joined.end())
    found.insert(found.end(), more->second.begin(), more->second.end());
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::vector<bool> TriangleMesh::is_boundary() const {
  std::vector<bool> boundary(vertices(), false);
  mesh_->for_each_boundary_edge([&](Index a, Index b) { boundary[a] = boundary[b] = true; });
  return boundary;
}

std::vector<std::vector<Index>> TriangleMesh::boundary_loops() const {
  const OpenTriMesh& mesh = mesh_->mesh;
  std::vector<std::vector<Index>> loops;
  std::vector<bool> passed(mesh.n_halfedges(), false);
  for (const auto start : mesh.halfedges()) {
    if (!start.is_boundary() || passed[start.idx()]) continue;
    std::vector<Index>& loop = loops.emplace_back();
    for (auto edge = start; !passed[edge.idx()]; edge = edge.next()) {
      passed[edge.idx()] = true;
      loop.push_back(edge.from().idx());
    }
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
  }
  std::sort(loops.begin(), loops.end());
  return loops;
}

void require_corners(TrianglesView faces, Index points) {
  for (Index f = 0; f < faces.size(); ++f)
    for (int c = 0; c < 3; ++c)
      if (faces[f][c] < 0 || faces[f][c] >= points)
        throw InvalidInput("face " + std::to_string(f) + " names point " +
                           std::to_string(faces[f][c]) + "; allowed is 0 to " +
                           std::to_string(points - 1));
}

double surface_area(PointsView points, TrianglesView faces) {
  double area = 0;
  for (Index f = 0; f < faces.size(); ++f) {
    const Vector3 x = points[faces[f][0]];
    area += (points[faces[f][1]] - x).cross(points[faces[f][2]] - x).norm() / 2;
  }
  return area;
}

}  // namespace symsurf
