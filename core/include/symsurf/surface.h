#pragma once

#include <symsurf/types.h>

#include <string>
#include <string_view>
#include <vector>

namespace symsurf {

/// One of the thesis's functions f(x, y) whose graphs serve as mirrors and as point clouds.
struct Surface {
  std::string name;     ///< "f1"
  std::string formula;  ///< "sin(0.7 x) cos(0.7 y)"
  double (*height)(double x, double y) = nullptr;
  Eigen::Vector2d (*slope)(double x, double y) = nullptr;

  /// f(x, y); NaN where it is undefined (f6 outside the unit disc).
  double operator()(double x, double y) const { return height(x, y); }
  /// (df/dx, df/dy); 0 across a crease or tip, not finite where f is undefined or vertical.
  Eigen::Vector2d gradient(double x, double y) const { return slope(x, y); }
};

/// f1 to f6.
const std::vector<Surface>& surfaces();

/// Throws InvalidParameter, listing the names there are.
const Surface& surface(std::string_view name);

/// "f1", ..., "f6".
std::vector<std::string> surface_names();

}  // namespace symsurf
