#include <symsurf/cylinder.h>

#include "../perpendicular/parametric_method.h"
#include "methods.h"

namespace symsurf {

namespace {

Result run_cylinder(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  return perpendicular::find_parametric("cylinder", perpendicular::cylinder_model, cloud, values,
                                        context);
}

}  // namespace

Method cylinder_method() {
  Method method;
  method.name = "cylinder";
  method.title = "Mirror cylinder";
  method.summary =
      "Finds the circular cylinder that mirrors the shape along its radius: a plane of symmetry "
      "bent"
      " about an axis.";
  method.parameters = perpendicular::search_parameters();
  method.minimum_points = 12;
  method.run = run_cylinder;
  return method;
}

}  // namespace symsurf
