#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <utility>

#include "base/math.h"
#include "base/named_values.h"
#include "mirrors/mirror_mesh.h"

namespace symsurf {

namespace {

using Slope = Eigen::Vector2d;

double sign(double value) { return static_cast<double>((value > 0) - (value < 0)); }

std::vector<Surface> make_surfaces() {
  return {
      {"f1", "sin(0.7 x) cos(0.7 y)",
       [](double x, double y) { return std::sin(0.7 * x) * std::cos(0.7 * y); },
       [](double x, double y) -> Slope {
         return {0.7 * std::cos(0.7 * x) * std::cos(0.7 * y),
                 -0.7 * std::sin(0.7 * x) * std::sin(0.7 * y)};
       }},
      {"f2", "sin(0.7 (x^2 + y^2)) / 0.7",
       [](double x, double y) { return std::sin(0.7 * (x * x + y * y)) / 0.7; },
       [](double x, double y) -> Slope {
         return 2 * std::cos(0.7 * (x * x + y * y)) * Slope(x, y);
       }},
      {"f3", "sqrt(x^2 + y^2)", [](double x, double y) { return std::sqrt(x * x + y * y); },
       [](double x, double y) -> Slope {
         const double radius = std::sqrt(x * x + y * y);
         return radius > 0 ? Slope(x / radius, y / radius) : Slope(0, 0);
       }},
      {"f4", "1 - |y|", [](double, double y) { return 1 - std::abs(y); },
       [](double, double y) -> Slope {
         return {0, -sign(y)};
       }},
      {"f5", "(sin(-0.65 - x) + sin(-0.35 - x) + sin(-0.05 - x) + sin(0.55 - x)) / 7",
       [](double x, double) {
         return (std::sin(-0.65 - x) + std::sin(-0.35 - x) + std::sin(-0.05 - x) +
                 std::sin(0.55 - x)) /
                7;
       },
       [](double x, double) -> Slope {
         return {-(std::cos(-0.65 - x) + std::cos(-0.35 - x) + std::cos(-0.05 - x) +
                   std::cos(0.55 - x)) /
                     7,
                 0};
       }},
      {"f6", "sqrt(1 - x^2 - y^2)", [](double x, double y) { return std::sqrt(1 - x * x - y * y); },
       [](double x, double y) -> Slope {
         const double height = std::sqrt(1 - x * x - y * y);
         return {-x / height, -y / height};
       }},
  };
}

}  // namespace

const std::vector<Surface>& surfaces() {
  static const std::vector<Surface> list = make_surfaces();
  return list;
}

const Surface& surface(std::string_view name) { return find_named(surfaces(), name, "surface"); }

std::vector<std::string> surface_names() {
  std::vector<std::string> names;
  for (const Surface& surface : surfaces()) names.push_back(surface.name);
  return names;
}

namespace {

// The point of the graph z = f(x, y) closest to p; not finite without one.
Vector3 closest_point(const Surface& surface, const Vector3& p) {
  using Position = Eigen::Vector2d;
  if (surface.name == "f6") {  // ends at a rim, along which a search for a minimum would get stuck
    const Vector3 u(p.x(), p.y(), std::max(p.z(), 0.0));
    const double length = u.norm();
    if (length > 0) return u / length;
    return p.z() >= 0 ? Vector3::UnitZ() : Vector3::UnitX();
  }
  const Position middle = p.head<2>();
  const auto squared = [&](const Position& s) {
    const double above = surface(s.x(), s.y()) - p.z();
    return std::isfinite(above) ? (s - middle).squaredNorm() + above * above : infinity;
  };
  const auto half_gradient = [&](const Position& s) -> Position {
    return s - middle + (surface(s.x(), s.y()) - p.z()) * surface.gradient(s.x(), s.y());
  };
  Position at = middle;
  const auto take = [&](const Position& candidate) {
    if (!(squared(candidate) < squared(at))) return false;
    at = candidate;
    return true;
  };

  // The closest point is no farther than the one straight above or below.
  constexpr int half = 12;
  double step = std::sqrt(squared(middle)) / half;
  if (!std::isfinite(step)) return Vector3::Constant(step - step);
  for (int i = -half; i <= half; ++i)
    for (int j = -half; j <= half; ++j) take(middle + step * Position(i, j));

  // Compass search: slow, but creases and rims do not stop it. Far away the waves of a surface
  // would keep it going for ever: where one step is better than the last by rounding only.
  const auto walk = [&](double until) {
    constexpr int most_moves = 256;  // of a length; near a surface there are a few
    for (; step > until; step /= 2) {
      bool moved = true;
      for (int moves = 0; moved && moves < most_moves; ++moves) {
        moved = false;
        for (int i = -1; i <= 1; ++i)
          for (int j = -1; j <= 1; ++j) moved |= take(at + step * Position(i, j));
      }
    }
  };
  // False where it does not come to rest: at a crease.
  const auto newton = [&] {
    for (int iteration = 0; iteration < 12; ++iteration) {
      constexpr double h = 1e-6;
      Eigen::Matrix2d hessian;
      for (int axis = 0; axis < 2; ++axis) {
        const Position beside = h * Position::Unit(axis);
        hessian.col(axis) = (half_gradient(at + beside) - half_gradient(at - beside)) / (2 * h);
      }
      const Position delta = hessian.inverse() * half_gradient(at);
      if (!(delta.norm() <= 1e-2) || squared(at - delta) > squared(at) * (1 + 1e-12) + 1e-30)
        return false;
      at -= delta;
      if (delta.norm() < 1e-15 * (1 + at.norm())) return true;
    }
    return half_gradient(at).norm() < 1e-12 * (1 + p.norm());
  };
  walk(1e-4);
  const Position coarse = at;
  if (!newton()) {
    at = coarse;
    walk(1e-14);
  }
  return {at.x(), at.y(), surface(at.x(), at.y())};
}

}  // namespace

SurfaceMirror::SurfaceMirror(const Surface& surface, Mapping mapping)
    : surface_(symsurf::surface(surface.name)), mapping_(mapping) {}

SurfaceMirror::SurfaceMirror(const Surface& surface, Mapping mapping, double scale,
                             const Matrix3& rotation, const Vector3& translation)
    : SurfaceMirror(surface, mapping) {
  if (!(scale > 0) || !std::isfinite(scale) || !translation.allFinite() ||
      !(rotation * rotation.transpose()).isIdentity(1e-9))
    throw InvalidInput("a surface needs a scale above 0, a rotation and a finite translation");
  placed_ = {scale, rotation, translation};
}

Vector3 SurfaceMirror::closest(const Vector3& x) const {
  return placed_(closest_point(surface_, to_frame(x)));
}

std::optional<Foot> SurfaceMirror::at(const Vector3& x) const {
  const Vector3 inside = to_frame(x);
  const double height = surface_(inside.x(), inside.y());
  const Vector3 foot = mapping_ == Mapping::Fixed ? Vector3(inside.x(), inside.y(), height)
                                                  : closest_point(surface_, inside);
  const double distance = (inside - foot).norm();
  if (!std::isfinite(distance)) return std::nullopt;
  const bool is_below = inside.z() < (std::isfinite(height) ? height : foot.z());
  const Slope slope = surface_.gradient(foot.x(), foot.y());
  Vector3 normal = Vector3(-slope.x(), -slope.y(), 1).normalized();
  if (!normal.allFinite()) normal = foot;  // on the rim of f6, a half sphere
  return Foot{placed_(foot), placed_.rotation * normal,
              placed_.scale * (is_below ? -distance : distance)};
}

// Of differences of the slope, which is exact; their errors are the sixth power of the step and
// rounding over it.
Matrix3 SurfaceMirror::shape_operator(const Foot& foot) const {
  Matrix3 bend = Matrix3::Zero();
  if (mapping_ == Mapping::Fixed) return bend;
  constexpr double step = 5e-3;  // of the surface's own unit, in which its waves are some long
  const Slope at = to_frame(foot.point).head<2>();
  for (int axis = 0; axis < 2; ++axis)
    for (const auto& [steps, weight] :
         {std::pair(1, 45.0), std::pair(2, -9.0), std::pair(3, 1.0)}) {
      const Slope beside = steps * step * Slope::Unit(axis);
      bend.col(axis).head<2>() -= weight / (60 * step) *
                                  (surface_.gradient(at.x() + beside.x(), at.y() + beside.y()) -
                                   surface_.gradient(at.x() - beside.x(), at.y() - beside.y()));
    }
  const Vector3 normal = placed_.rotation.transpose() * foot.normal;
  const Matrix3 tangent = placed_.rotation * across(normal);
  return tangent * bend * tangent.transpose() * (normal.z() / placed_.scale);
}

Values SurfaceMirror::numbers() const {
  return {{"surface", surface_.name},
          {"mapping", std::string(mapping_ == Mapping::Fixed ? "fixed" : "perpendicular")},
          {"scale", placed_.scale},
          {"rotation", Eigen::MatrixXd(placed_.rotation)},
          {"translation", placed_.translation}};
}

std::unique_ptr<Mirror> SurfaceMirror::moved(const Motion& by) const {
  return std::make_unique<SurfaceMirror>(surface_, mapping_, by.scale * placed_.scale,
                                         by.rotation * placed_.rotation, by(placed_.translation));
}

Mesh SurfaceMirror::mesh_over(const std::vector<Foot>& feet, int resolution,
                              const Context& context) const {
  Eigen::MatrixX2d flat(feet.size(), 2);
  for (std::size_t i = 0; i < feet.size(); ++i) flat.row(i) = to_frame(feet[i].point).head<2>();
  const Mesh grid = box_mesh(flat, resolution, context, [&](const Eigen::Vector2d& at) {
    return placed_({at.x(), at.y(), surface_(at.x(), at.y())});
  });
  // Where the surface is undefined the grid has holes.
  return part_of(grid, [&](Index t) {
    return grid.vertices(grid.triangles.row(t), Eigen::indexing::all).allFinite();
  });
}

}  // namespace symsurf
