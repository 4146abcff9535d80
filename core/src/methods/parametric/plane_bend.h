#pragma once

#include <symsurf/points.h>

#include "methods/parametric/unit_cylinder.h"
#include "methods/parametric/unit_sphere.h"

namespace symsurf {

/// How a mirror next to a plane bends, in the principal frame: to the second order its height over
/// the plane through the point is e' C e / 2, e the offset along the plane.
struct PlaneBend {
  Vector3 point, normal;
  Vector3 most_bent;               ///< the principal direction of the greater curvature
  double greater = 0, lesser = 0;  ///< principal curvatures, by amount; to the normal's side

  UnitSphere sphere() const { return {point, normal, -(greater + lesser) / 2}; }
  UnitCylinder cylinder() const {
    return {point + normal / greater, normal.cross(most_bent), 1 / std::abs(greater)};
  }
};

}  // namespace symsurf
