#pragma once

#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

#include <cmath>

namespace symsurf {

struct TestMesh {
  Points vertices = Points(0, 3);
  Triangles faces = Triangles(0, 3);

  void add(const Points& more, const Triangles& triangles) {
    const Index had = vertices.rows(), faces_had = faces.rows();
    vertices.conservativeResize(had + more.rows(), 3);
    vertices.bottomRows(more.rows()) = more;
    faces.conservativeResize(faces_had + triangles.rows(), 3);
    faces.bottomRows(triangles.rows()) = triangles.array() + had;
  }

  // Twelve triangles; `flips` says of each side which of its diagonals divides it.
  void add_box(const Vector3& low, const Vector3& high, unsigned flips = 0) {
    Points corners(8, 3);
    for (int i = 0; i < 8; ++i)
      for (int axis = 0; axis < 3; ++axis) corners(i, axis) = (i >> axis & 1 ? high : low)[axis];
    constexpr int sides[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                 {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
    Triangles triangles(12, 3);
    for (int s = 0; s < 6; ++s) {
      const auto& c = sides[s];
      const int turn = flips >> s & 1;
      triangles.row(2 * s) << c[turn], c[1 + turn], c[2 + turn];
      triangles.row(2 * s + 1) << c[turn], c[2 + turn], c[(3 + turn) % 4];
    }
    add(corners, triangles);
  }

  void move(const Matrix3& rotation, const Vector3& shift) {
    vertices = ((vertices * rotation.transpose()).rowwise() + shift.transpose()).eval();
  }
};

inline Result detected(const TestMesh& mesh, const char* method,
                       const Points& normals = Points(0, 3)) {
  return detect(mesh.vertices, {.method = method, .normals = normals, .faces = mesh.faces});
}

inline bool is_plane(const Result& result, const Vector3& normal, const Vector3& on) {
  const auto* plane = dynamic_cast<const Plane*>(result.mirror.get());
  return plane && std::abs(plane->normal().dot(normal)) > std::cos(0.01) &&
         std::abs(plane->normal().dot(on) + plane->offset()) < 0.01;
}

}  // namespace symsurf
