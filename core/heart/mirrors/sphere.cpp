#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mirrors/mirror_mesh.h"

namespace symsurf {

namespace {

// From the unit square to the unit disc as (radius, angle), squares to circles (Shirley and Chiu,
// "A low distortion map between disk and square", 1997).
std::pair<double, double> disc_from_square(double s, double t) {
  constexpr double quarter = std::numbers::pi / 4;
  const double a = 2 * s - 1, b = 2 * t - 1;
  if (a == 0 && b == 0) return {0, 0};
  if (std::abs(a) > std::abs(b)) return {a, quarter * b / a};
  return {b, 2 * quarter - quarter * a / b};
}

}  // namespace

Sphere::Sphere(const Vector3& centre, double radius) : centre_(centre), radius_(radius) {
  if (!centre.allFinite() || !(radius > 0) || !std::isfinite(radius))
    throw InvalidInput("a sphere needs a finite centre and a finite radius above 0; given " +
                       to_string(Value(centre)) + " and " + to_string(Value(radius)));
}

Vector3 Sphere::foot(const Vector3& x) const {
  const Vector3 u = x - centre_;
  const double distance = u.norm();
  return distance > 0 ? Vector3(centre_ + radius_ / distance * u) : no_point();
}

double Sphere::signed_distance(const Vector3& x) const {
  const double distance = (x - centre_).norm();
  return distance > 0 ? distance - radius_ : std::numeric_limits<double>::quiet_NaN();
}

bool Sphere::has_image(const Vector3& x) const {
  const double distance = (x - centre_).norm();
  return distance > 0 && distance <= 2 * radius_;
}

Values Sphere::numbers() const { return {{"centre", centre_}, {"radius", radius_}}; }

std::unique_ptr<Mirror> Sphere::transformed(double scale, const Matrix3& rotation,
                                            const Vector3& translation) const {
  return std::make_unique<Sphere>(scale * rotation * centre_ + translation, scale * radius_);
}

Mesh Sphere::mesh_over(PointsView object, int resolution, const Context& context) const {
  constexpr double pi = std::numbers::pi;
  std::vector<Vector3> directions;
  Vector3 sum = Vector3::Zero();
  for (Index i = 0; i < object.size(); ++i) {
    if (!has_image(object[i])) continue;
    directions.push_back((object[i] - centre_).normalized());
    sum += directions.back();
  }
  if (directions.empty())
    throw InvalidInput("none of the " + std::to_string(object.size()) +
                       " points of the object has an image over this sphere");

  const bool balanced = sum.norm() < 1e-9 * static_cast<double>(directions.size());
  const Vector3 pole = balanced ? Vector3(Vector3::UnitZ()) : Vector3(sum.normalized());
  double opening = 0;
  for (const Vector3& u : directions)
    opening = std::max(opening, std::atan2(pole.cross(u).norm(), pole.dot(u)));
  if (opening > 0.9 * pi) opening = pi;

  const Vector3 e1 = pole.unitOrthogonal(), e2 = pole.cross(e1);
  const Mesh mesh =
      grid_mesh({resolution, resolution}, context, [&](double s, double t) -> Vector3 {
        const auto [rho, angle] = disc_from_square(s, t);
        const double polar = opening * rho;
        return centre_ +
               radius_ * (std::cos(polar) * pole +
                          std::sin(polar) * (std::cos(angle) * e1 + std::sin(angle) * e2));
      });
  // Where the cap closes to the whole sphere its rim is one point.
  if (opening < pi) return mesh;
  const double side = radius_ * pi / resolution;
  return part_of(mesh, [&](Index t) {
    const Matrix3 corners = mesh.vertices(mesh.triangles.row(t), Eigen::indexing::all);
    const Vector3 one = corners.row(1) - corners.row(0), other = corners.row(2) - corners.row(0);
    return one.cross(other).norm() >= 1e-9 * side * side;
  });
}

}  // namespace symsurf
