#include <symsurf/mirrors.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/math.h"
#include "reflection_search.h"

namespace symsurf {

namespace {

constexpr int cells = 32;          // of the mesh, along the longer side
constexpr double beyond = 0.5;     // of a triangle, up to which its gradient is continued
constexpr double compared = 1e-5;  // of the footprint, between normals for the curvature

// What is known of the mirror's extent: its footprint, its nodes or its patches.
Mesh mesh_of(const Mirror& mirror) {
  if (!mirror.footprint().empty()) return mirror.mesh(cells);
  if (const auto* field = dynamic_cast<const HeightField*>(&mirror))
    return mirror.mesh(field->nodes(), cells);
  if (const auto* form = dynamic_cast<const FreeForm*>(&mirror)) {
    std::vector<Vector3> centres;
    for (const Patch& patch : form->patches()) centres.push_back(patch.centre);
    return mirror.mesh(rows_of(centres), cells);
  }
  return mirror.mesh(cells);
}

}  // namespace

FootprintReflection::Tangent FootprintReflection::tangent_of(const Mirror& mirror) {
  if (const auto* form = dynamic_cast<const FreeForm*>(&mirror))
    return [form](const Vector3& x, Vector3& foot, Vector3& normal) {
      constexpr double full_precision = 1e-14;
      return form->foot(x, full_precision, foot, normal);
    };
  if (const auto* field = dynamic_cast<const HeightField*>(&mirror))
    return [field](const Vector3& x, Vector3& foot, Vector3& normal) {
      foot = field->foot(x);
      normal = field->normal(x);
      return foot.allFinite() && normal.allFinite();
    };
  const auto& known = dynamic_cast<const SurfaceMirror&>(mirror);
  return [&known](const Vector3& x, Vector3& foot, Vector3& normal) {
    const Vector3 at = known.to_frame(x);
    const double height = known.surface()(at.x(), at.y());
    const Eigen::Vector2d slope = known.surface().gradient(at.x(), at.y());
    foot = x + known.scale() * (height - at.z()) * known.direction();
    // z - f(x, y) grows along the normal: its gradient, through the frame's directions.
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3 d = known.to_frame(x + known.scale() * Vector3::Unit(axis)) - at;
      normal[axis] = d.z() - slope.dot(d.head<2>());
    }
    normal.normalize();
    return foot.allFinite() && normal.allFinite();
  };
}

FootprintReflection::FootprintReflection(const Mirror& mirror, const Vector3& eye)
    : eye_(eye), tangent_(tangent_of(mirror)) {
  const Mesh mesh = mesh_of(mirror);
  for (const auto& vertex : mesh.vertices.rowwise()) {
    Vector3 foot = vertex.transpose(), normal;
    if (!tangent_(vertex.transpose(), foot, normal)) normal.setConstant(std::nan(""));
    feet_.push_back(foot);
    normals_.push_back(normal);
  }
  triangles_ = mesh.triangles;
  step_ =
      mesh.vertices.rows() == 0
          ? 0
          : compared *
                (mesh.vertices.colwise().maxCoeff() - mesh.vertices.colwise().minCoeff()).norm();
}

bool FootprintReflection::at(const Vector3& x, SurfacePoint& found) const {
  if (!tangent_(x, found.position, found.normal)) return false;
  const auto across = orthogonal_to(found.normal);
  Eigen::Matrix<double, 3, 2> turn;
  for (int k = 0; k < 2; ++k) {
    Vector3 foot, ahead, behind;
    if (!tangent_(found.position + step_ * across.col(k), foot, ahead) ||
        !tangent_(found.position - step_ * across.col(k), foot, behind))
      return false;
    turn.col(k) = (ahead - behind) / (2 * step_);
  }
  const Eigen::Matrix2d bend = across.transpose() * turn;
  found.shape = across * (bend + bend.transpose()) / 2 * across.transpose();
  return true;
}

std::vector<SurfacePoint> FootprintReflection::operator()(const Vector3& source) const {
  const LightPath path{source, eye_};
  const auto surface = [this](const Vector3& x, SurfacePoint& point) { return at(x, point); };
  std::vector<Vector3> descents;
  for (std::size_t i = 0; i < feet_.size(); ++i)
    descents.push_back(path.descent(feet_[i], normals_[i]));
  std::vector<SurfacePoint> found;
  for (const auto& triangle : triangles_.rowwise()) {
    const Vector3 &a = feet_[triangle[0]], &b = feet_[triangle[1]], &c = feet_[triangle[2]];
    // Barycentric coordinates of the point at which the interpolated gradient is 0.
    const auto basis = orthogonal_to((b - a).cross(c - a).stableNormalized());
    Eigen::Matrix<double, 2, 3> w;
    for (int k = 0; k < 3; ++k) w.col(k) = basis.transpose() * descents[triangle[k]];
    const auto minor = [&](int i, int j) { return w(0, i) * w(1, j) - w(1, i) * w(0, j); };
    Vector3 parts(minor(1, 2), minor(2, 0), minor(0, 1));
    parts /= parts.sum();
    if (!(parts.minCoeff() >= -beyond)) continue;
    const Vector3 start = parts[0] * a + parts[1] * b + parts[2] * c;
    const double side = std::max((b - a).norm(), (c - a).norm());
    SurfacePoint point;
    if (converges(path, surface, start, side, point) && (point.position - start).norm() <= 2 * side)
      found.push_back(point);
  }
  return found;
}

}  // namespace symsurf
