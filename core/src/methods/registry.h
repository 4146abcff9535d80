#pragma once

#include <symsurf/method.h>

// The list of methods. A new one is its own source file, a line here and a line in methods.cpp.

namespace symsurf {

Method auto_method();
Method plane_method();
Method sphere_method();
Method fixed_direction_method();
Method perpendicular_method();
Method cylinder_method();
Method quadric_method();
Method separation_method();
Method separation_normals_method();
Method normals_only_method();
Method sphere_thesis_method();

}  // namespace symsurf
