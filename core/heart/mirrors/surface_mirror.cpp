#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

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

using Position = Eigen::Vector2d;

class Search {
 public:
  Search(const Surface& surface, const Vector3& p) : surface_(surface), p_(p) {}

  Position at = Position::Zero();

  double squared(const Position& s) const {
    const double height = surface_(s.x(), s.y());
    if (!std::isfinite(height)) return std::numeric_limits<double>::infinity();
    return (s - p_.head<2>()).squaredNorm() + (height - p_.z()) * (height - p_.z());
  }

  void start(double reach) {
    constexpr int half = 12;
    const Position middle = p_.head<2>();
    at = middle;
    for (int i = -half; i <= half; ++i)
      for (int j = -half; j <= half; ++j) take(middle + reach / half * Position(i, j));
    step_ = reach / half;
  }

  // Compass search: slow, but creases and rims do not stop it. Far away the waves of a surface
  // would keep it going for ever: where one step is better than the last by rounding only.
  void walk(double until) {
    constexpr int most_moves = 256;  // of a length; near a surface there are a few
    for (; step_ > until; step_ /= 2) {
      bool moved = true;
      for (int moves = 0; moved && moves < most_moves; ++moves) {
        moved = false;
        for (const Position& way :
             {Position(1, 0), Position(-1, 0), Position(0, 1), Position(0, -1), Position(1, 1),
              Position(-1, -1), Position(1, -1), Position(-1, 1)})
          moved |= take(at + step_ * way);
      }
    }
  }

  // False where it does not come to rest: at a crease.
  bool newton() {
    for (int iteration = 0; iteration < 12; ++iteration) {
      const Position g = half_gradient(at);
      if (!g.allFinite()) return false;
      constexpr double h = 1e-6;
      Eigen::Matrix2d hessian;
      hessian.col(0) =
          (half_gradient(at + Position(h, 0)) - half_gradient(at - Position(h, 0))) / (2 * h);
      hessian.col(1) =
          (half_gradient(at + Position(0, h)) - half_gradient(at - Position(0, h))) / (2 * h);
      const Position delta = hessian.fullPivLu().solve(g);
      if (!delta.allFinite() || delta.norm() > 1e-2) return false;
      const Position next = at - delta;
      if (squared(next) > squared(at) * (1 + 1e-12) + 1e-30) return false;
      at = next;
      if (delta.norm() < 1e-15 * (1 + at.norm())) return true;
    }
    return half_gradient(at).norm() < 1e-12 * (1 + p_.norm());
  }

 private:
  bool take(const Position& candidate) {
    if (!(squared(candidate) < squared(at))) return false;
    at = candidate;
    return true;
  }
  Position half_gradient(const Position& s) const {
    return s - p_.head<2>() + (surface_(s.x(), s.y()) - p_.z()) * surface_.gradient(s.x(), s.y());
  }

  const Surface& surface_;
  Vector3 p_;
  double step_ = 1;
};

// f6 ends at a rim, along which a search for a minimum would get stuck.
Vector3 closest_on_half_sphere(const Vector3& p) {
  const Vector3 u = p.z() >= 0 ? p : Vector3(p.x(), p.y(), 0);
  const double length = u.norm();
  return length > 0 ? Vector3(u / length)
                    : Vector3(p.z() >= 0 ? Vector3::UnitZ() : Vector3::UnitX());
}

// The point of the graph z = f(x, y) closest to p.
Vector3 closest_point(const Surface& surface, const Vector3& p) {
  if (!p.allFinite()) return Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  if (surface.name == "f6") return closest_on_half_sphere(p);
  Search search(surface, p);
  // The closest point is no farther than the one straight above or below.
  const double reach = std::sqrt(search.squared(p.head<2>()));
  if (!std::isfinite(reach)) return Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  search.start(reach);
  search.walk(1e-4);
  const Eigen::Vector2d coarse = search.at;
  if (!search.newton()) {
    search.at = coarse;
    search.walk(1e-14);
  }
  return {search.at.x(), search.at.y(), surface(search.at.x(), search.at.y())};
}

}  // namespace

SurfaceMirror::SurfaceMirror(const Surface& surface, Mapping mapping)
    : surface_(symsurf::surface(surface.name)), mapping_(mapping) {}

SurfaceMirror::SurfaceMirror(const Surface& surface, Mapping mapping, double scale,
                             const Matrix3& rotation, const Vector3& translation)
    : SurfaceMirror(surface, mapping) {
  const Matrix3 product = rotation * rotation.transpose();
  if (!(scale > 0) || !std::isfinite(scale) || !translation.allFinite() ||
      !(product - Matrix3::Identity()).isZero(1e-9))
    throw InvalidInput("a surface needs a scale above 0, a rotation and a finite translation");
  scale_ = scale;
  rotation_ = rotation;
  translation_ = translation;
}

Vector3 SurfaceMirror::closest_in_frame(const Vector3& x) const {
  return closest_point(surface_, x);
}

Vector3 SurfaceMirror::foot_in_frame(const Vector3& x) const {
  if (mapping_ == Mapping::Perpendicular) return closest_in_frame(x);
  const double height = surface_(x.x(), x.y());
  return std::isfinite(height) ? Vector3(x.x(), x.y(), height) : no_point();
}

Vector3 SurfaceMirror::foot(const Vector3& x) const { return position(foot_in_frame(to_frame(x))); }

double SurfaceMirror::signed_distance(const Vector3& x) const {
  const Vector3 inside = to_frame(x), foot = foot_in_frame(inside);
  const double height = surface_(inside.x(), inside.y());
  const bool below = std::isfinite(height) ? inside.z() < height : inside.z() < foot.z();
  return scale_ * (below ? -1 : 1) * (inside - foot).norm();
}

Values SurfaceMirror::numbers() const {
  return {{"surface", surface_.name},
          {"mapping", std::string(mapping_ == Mapping::Fixed ? "fixed" : "perpendicular")},
          {"scale", scale_},
          {"rotation", Eigen::MatrixXd(rotation_)},
          {"translation", translation_}};
}

std::unique_ptr<Mirror> SurfaceMirror::transformed(double scale, const Matrix3& rotation,
                                                   const Vector3& translation) const {
  return std::make_unique<SurfaceMirror>(surface_, mapping_, scale * scale_, rotation * rotation_,
                                         scale * (rotation * translation_) + translation);
}

Mesh SurfaceMirror::mesh_over(PointsView object, int resolution, const Context& context) const {
  Eigen::Array2d low = Eigen::Array2d::Constant(infinity), high = -low;
  for (Index i = 0; i < object.size(); ++i) {
    const Vector3 foot = foot_in_frame(to_frame(object[i]));
    if (!foot.allFinite()) continue;
    low = low.min(foot.head<2>().array());
    high = high.max(foot.head<2>().array());
  }
  if (!low.allFinite())
    throw InvalidInput("surface " + surface_.name + " is undefined at all " +
                       std::to_string(object.size()) + " points");
  const Eigen::Array2d size = high - low;
  const GridCells cells = grid_cells(size.x(), size.y(), resolution);
  const Mesh grid = grid_mesh(cells, context, [&](double s, double t) -> Vector3 {
    const double x = low.x() + s * size.x(), y = low.y() + t * size.y();
    return position({x, y, surface_(x, y)});
  });
  // Where the surface is undefined the grid has holes.
  return part_of(grid, [&](Index t) {
    return grid.vertices(grid.triangles.row(t), Eigen::indexing::all).allFinite();
  });
}

}  // namespace symsurf
