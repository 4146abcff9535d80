#include <symsurf/mirrors.h>

#include <cmath>

#include "base/find_named.h"

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

}  // namespace symsurf
