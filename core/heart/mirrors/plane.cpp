#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <Eigen/Geometry>
#include <cmath>

#include "base/eigenvectors.h"
#include "base/math.h"
#include "mirrors/mirror_mesh.h"

namespace symsurf {

Plane::Plane(const Vector3& normal, double offset) {
  const double length = length_of(normal);
  if (!(length > 0) || !std::isfinite(length) || !std::isfinite(offset / length))
    throw InvalidInput(
        "a plane needs a normal of finite length above 0 and a finite offset; given " +
        to_string(Value(normal)) + " and " + to_string(Value(offset)));
  normal_ = normal / length;
  offset_ = offset / length;
}

Matrix4 Plane::matrix() const {
  Matrix4 m = Matrix4::Identity();
  m.topLeftCorner<3, 3>() -= 2 * normal_ * normal_.transpose();
  m.topRightCorner<3, 1>() = -2 * offset_ * normal_;
  return m;
}

Matrix3 Plane::axes() const {
  Matrix3 rows;
  rows << orthogonal_to(normal_).transpose(), normal_.transpose();
  return rows;
}

Values Plane::numbers() const { return {{"normal", normal_}, {"offset", offset_}}; }

std::unique_ptr<Mirror> Plane::transformed(double scale, const Matrix3& rotation,
                                           const Vector3& translation) const {
  const Vector3 normal = rotation * normal_;
  return std::make_unique<Plane>(normal, scale * offset_ - normal.dot(translation));
}

// The rectangle along the footprint's principal axes, so that it turns with the object.
Mesh Plane::mesh_over(PointsView object, int resolution, const Context& context) const {
  const Points feet = project(object);
  const Eigen::RowVector3d centre = feet.colwise().mean();
  const Points centred = feet.rowwise() - centre;
  const Vector3 u = eigen_of_scatter(centred).vectors.col(2);
  const Vector3 v = normal_.cross(u).normalized();
  const Eigen::VectorXd along_u = centred * u, along_v = centred * v;
  const double u0 = along_u.minCoeff(), v0 = along_v.minCoeff();
  const double width = along_u.maxCoeff() - u0, height = along_v.maxCoeff() - v0;
  return grid_mesh(grid_cells(width, height, resolution), context,
                   [&](double s, double t) -> Vector3 {
                     return centre.transpose() + (u0 + s * width) * u + (v0 + t * height) * v;
                   });
}

}  // namespace symsurf
