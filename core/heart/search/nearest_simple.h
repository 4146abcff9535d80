#pragma once

#include <symsurf/mirrors.h>

namespace symsurf {

/// How far a free form is, root mean square of its patches' centres, from the sphere that fits them
/// best (least squares: Coope 1993).
double distance_from_sphere(const FreeForm& mirror);

/// The same of the circular cylinder, its axis the direction that lies across most of the normals.
double distance_from_cylinder(const FreeForm& mirror);

}  // namespace symsurf
