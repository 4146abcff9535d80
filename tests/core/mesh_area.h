#pragma once

#include <symsurf/mirror.h>

#include <Eigen/Geometry>

namespace symsurf {

inline double area(const Mesh& mesh) {
  double sum = 0;
  for (Index t = 0; t < mesh.triangles.rows(); ++t) {
    const Vector3 a = mesh.vertices.row(mesh.triangles(t, 0));
    const Vector3 b = mesh.vertices.row(mesh.triangles(t, 1));
    const Vector3 c = mesh.vertices.row(mesh.triangles(t, 2));
    sum += (b - a).cross(c - a).norm() / 2;
  }
  return sum;
}

}  // namespace symsurf
