#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/linear_algebra.h"
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

std::unique_ptr<Mirror> Plane::moved(const Motion& by) const {
  const Vector3 normal = by.rotation * normal_;
  return std::make_unique<Plane>(normal, by.scale * offset_ - normal.dot(by.translation));
}

// The rectangle along the footprint's principal axes, so that it turns with the object.
Mesh Plane::mesh_over(const std::vector<Foot>& feet, int resolution, const Context& context) const {
  Points centred = points_of(feet);
  const Eigen::RowVector3d centre = centred.colwise().mean();
  centred.rowwise() -= centre;
  Eigen::Matrix<double, 3, 2> axes;
  axes.col(0) = eigen_of_scatter(centred).vectors.col(2);
  axes.col(1) = normal_.cross(axes.col(0)).normalized();
  return box_mesh(centred * axes, resolution, context, [&](const Eigen::Vector2d& at) -> Vector3 {
    return centre.transpose() + axes * at;
  });
}

ObliquePlane::ObliquePlane(const Vector3& normal, double offset, const Vector3& direction)
    : plane_(normal, offset) {
  constexpr double least_rise = 1.7e-4;  // sine of the angle with the plane
  const double length = length_of(direction);
  direction_ = direction / length;
  const double rise = plane_.normal().dot(direction_);
  if (!(std::abs(rise) > least_rise) || !direction_.allFinite())
    throw InvalidInput("an oblique plane needs a direction that leaves it; given the normal " +
                       to_string(Value(normal)) + " and the direction " +
                       to_string(Value(direction)));
  if (rise < 0) direction_ = -direction_;
}

double ObliquePlane::obliquity() const {
  return std::atan2(normal().cross(direction_).norm(), normal().dot(direction_));
}

Matrix4 ObliquePlane::matrix() const {
  const Vector3 stretched = 2 / normal().dot(direction_) * direction_;
  Matrix4 m = Matrix4::Identity();
  m.topLeftCorner<3, 3>() -= stretched * normal().transpose();
  m.topRightCorner<3, 1>() = -offset() * stretched;
  return m;
}

Values ObliquePlane::numbers() const {
  return {{"normal", normal()}, {"offset", offset()}, {"direction", direction_}};
}

std::unique_ptr<Mirror> ObliquePlane::moved(const Motion& by) const {
  const Vector3 normal = by.rotation * plane_.normal();
  return std::make_unique<ObliquePlane>(normal, by.scale * offset() - normal.dot(by.translation),
                                        by.rotation * direction_);
}

Mesh ObliquePlane::mesh_over(const std::vector<Foot>& feet, int resolution,
                             const Context& context) const {
  return plane_.mesh(points_of(feet), resolution, context);
}

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

// The foot on a circle about the base, out of which x lies by `from`.
std::optional<Foot> radial_foot(const Vector3& base, const Vector3& from, double radius) {
  const double distance = from.norm();
  if (!(distance > 0)) return std::nullopt;
  return Foot{base + radius / distance * from, from / distance, distance - radius};
}

// The mean normal, or the other where they cancel each other out.
Vector3 mean_normal(const std::vector<Foot>& feet, const Vector3& other) {
  Vector3 sum = Vector3::Zero();
  for (const Foot& foot : feet) sum += foot.normal;
  const bool balanced = sum.norm() < 1e-9 * static_cast<double>(feet.size());
  return balanced ? other : sum.normalized();
}

}  // namespace

Sphere::Sphere(const Vector3& centre, double radius) : centre_(centre), radius_(radius) {
  if (!centre.allFinite() || !(radius > 0) || !std::isfinite(radius))
    throw InvalidInput("a sphere needs a finite centre and a finite radius above 0; given " +
                       to_string(Value(centre)) + " and " + to_string(Value(radius)));
}

std::optional<Foot> Sphere::at(const Vector3& x) const {
  return radial_foot(centre_, x - centre_, radius_);
}

Matrix3 Sphere::shape_operator(const Foot& foot) const { return across(foot.normal) / radius_; }

Values Sphere::numbers() const { return {{"centre", centre_}, {"radius", radius_}}; }

std::unique_ptr<Mirror> Sphere::moved(const Motion& by) const {
  return std::make_unique<Sphere>(by(centre_), by.scale * radius_);
}

Mesh Sphere::mesh_over(const std::vector<Foot>& feet, int resolution,
                       const Context& context) const {
  constexpr double pi = std::numbers::pi;
  const Vector3 pole = mean_normal(feet, Vector3::UnitZ());
  double opening = 0;
  for (const auto& [point, u, distance] : feet)
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

Cylinder::Cylinder(const Vector3& point, const Vector3& axis, double radius)
    : point_(point), axis_(axis / length_of(axis)), radius_(radius) {
  const double length = length_of(axis);
  if (!point.allFinite() || !(length > 0) || !std::isfinite(length) || !(radius > 0) ||
      !std::isfinite(radius))
    throw InvalidInput(
        "a cylinder needs a finite point, an axis of finite length above 0 and a finite radius "
        "above 0; given " +
        to_string(Value(point)) + ", " + to_string(Value(axis)) + " and " +
        to_string(Value(radius)));
}

std::optional<Foot> Cylinder::at(const Vector3& x) const {
  const Vector3 d = x - point_, from = d - d.dot(axis_) * axis_;
  return radial_foot(x - from, from, radius_);
}

Matrix3 Cylinder::shape_operator(const Foot& foot) const {
  return (across(foot.normal) - axis_ * axis_.transpose()) / radius_;
}

Values Cylinder::numbers() const {
  return {{"point", point_}, {"axis", axis_}, {"radius", radius_}};
}

std::unique_ptr<Mirror> Cylinder::moved(const Motion& by) const {
  return std::make_unique<Cylinder>(by(point_), by.rotation * axis_, by.scale * radius_);
}

Mesh Cylinder::mesh_over(const std::vector<Foot>& feet, int resolution,
                         const Context& context) const {
  // Angles are counted from the mean direction, so that the shell's gap falls opposite to it.
  const Vector3 e1 = mean_normal(feet, axis_.unitOrthogonal()), e2 = axis_.cross(e1);
  Eigen::MatrixX2d unrolled(feet.size(), 2);
  for (std::size_t i = 0; i < feet.size(); ++i)
    unrolled.row(i) << radius_ * std::atan2(feet[i].normal.dot(e2), feet[i].normal.dot(e1)),
        axis_.dot(feet[i].point - point_);
  return box_mesh(unrolled, resolution, context, [&](const Eigen::Vector2d& at) -> Vector3 {
    const double angle = at.x() / radius_;
    return point_ + at.y() * axis_ + radius_ * (std::cos(angle) * e1 + std::sin(angle) * e2);
  });
}

Quadric::Quadric(const Matrix3& matrix, const Vector3& linear, double constant)
    : Quadric(matrix, Vector3::Zero(), linear, constant) {}

Quadric::Quadric(const Matrix3& matrix, const Vector3& origin, const Vector3& gradient,
                 double value)
    : origin_(origin),
      matrix_((matrix + matrix.transpose()) / 2),
      linear_(gradient),
      constant_(value) {
  // Not only those given, but also those about the coordinates' own origin, which numbers() names.
  if (!matrix_.allFinite() || !origin.allFinite() || !gradient.allFinite() ||
      !std::isfinite(value) || !linear().allFinite() || !std::isfinite(constant()) ||
      (matrix_.isZero(0) && gradient.isZero(0)))
    throw InvalidInput("a quadric needs finite numbers, and not all of A and b zero");
  const SymmetricEigen<3> eigen = eigen_of(matrix_);
  axes_ = eigen.vectors;
  curves_ = eigen.values;
}

std::optional<Foot> Quadric::at(const Vector3& x) const {
  // In the eigenvectors' frame: y_i = (x_i - l b_i) / (1 + 2 l a_i). Between the poles f(y(l))
  // falls monotonically, so its zero there, if any, is one, and the closest point.
  const Vector3 p = axes_.transpose() * (x - origin_), b = axes_.transpose() * linear_;
  Vector3 y, g;
  double slope;
  const auto f = [&](double l) {
    const Eigen::Array3d below = 1 + 2 * l * curves_.array();
    y = (p - l * b).array() / below;
    g = 2 * curves_.cwiseProduct(y) + b;
    slope = -(g.array().square() / below).sum();
    return (curves_.array() * y.array().square()).sum() + b.dot(y) + constant_;
  };
  const double most = curves_.maxCoeff(), least = curves_.minCoeff();
  double low = most > 0 ? -1 / (2 * most) : -infinity;
  double high = least < 0 ? -1 / (2 * least) : infinity;

  double l = 0, value = f(l);
  for (int step = 0; step < 200; ++step) {
    if (value == 0 || slope == 0) break;
    (value > 0 ? low : high) = l;
    double next = l - value / slope;
    if (next == l) break;
    if (!(next > low && next < high)) {
      if (std::isinf(low) || std::isinf(high)) return std::nullopt;
      next = (low + high) / 2;
    }
    const double moved = std::abs(next - l);
    l = next;
    value = f(l);
    if (moved <= 1e-16 * std::abs(l)) break;
  }
  const double size = g.norm() * (y.norm() + (p - y).norm()) + std::abs(constant_);
  if (!y.allFinite() || !(std::abs(value) <= 1e-9 * size)) return std::nullopt;
  const Vector3 point = origin_ + axes_ * y;
  const double distance = (x - point).norm();
  return Foot{point, axes_ * g.stableNormalized(), this->value(x) < 0 ? -distance : distance};
}

Matrix3 Quadric::shape_operator(const Foot& foot) const {
  const Matrix3 tangent = across(foot.normal);
  return tangent * matrix_ * tangent * (2 / gradient(foot.point).norm());
}

Values Quadric::numbers() const {
  return {{"matrix", Eigen::MatrixXd(matrix_)},
          {"linear", linear()},
          {"constant", constant()},
          {"origin", origin_},
          {"gradient", linear_},
          {"value", constant_}};
}

// f((R'(x - t)) / s), times s^2.
std::unique_ptr<Mirror> Quadric::moved(const Motion& by) const {
  return std::make_unique<Quadric>(by.rotation * matrix_ * by.rotation.transpose(), by(origin_),
                                   by.scale * (by.rotation * linear_),
                                   by.scale * by.scale * constant_);
}

Mesh Quadric::mesh_over(const std::vector<Foot>& feet, int resolution,
                        const Context& context) const {
  return surface_net(
      *this, feet, resolution, [this](const Vector3& x) { return value(x); }, context);
}

}  // namespace symsurf
