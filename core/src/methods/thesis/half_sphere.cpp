#include "methods/thesis/half_sphere.h"

#include <cmath>
#include <numbers>

namespace symsurf {

std::vector<Vector3> half_sphere(Index steps) {
  const double step = std::numbers::pi / static_cast<double>(steps);
  std::vector<Vector3> directions{Vector3::UnitZ()};
  for (Index i = 1; i < steps; ++i)
    for (Index j = 0; j < steps; ++j) {
      const double phi = static_cast<double>(i) * step, theta = static_cast<double>(j) * step;
      directions.emplace_back(std::sin(phi) * std::cos(theta), std::sin(phi) * std::sin(theta),
                              std::cos(phi));
    }
  return directions;
}

}  // namespace symsurf
