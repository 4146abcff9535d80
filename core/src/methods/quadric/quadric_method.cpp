#include <symsurf/quadric.h>

#include "methods/free_form/parametric_method.h"
#include "methods/free_form/search.h"
#include "methods/registry.h"

namespace symsurf {

namespace {

Result run_quadric(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  return perpendicular::find_parametric("quadric", perpendicular::quadric_model, cloud, values,
                                        context);
}

}  // namespace

MethodImplementation quadric_method() {
  MethodImplementation method;
  method.name = "quadric";
  method.title = "Mirror quadric";
  method.summary =
      "Finds the quadric (ellipsoid, paraboloid, cone, saddle, ...) that mirrors the shape along "
      "its"
      " normals.";
  method.parameters = perpendicular::search_parameters();
  method.minimum_points = perpendicular::least_points;
  method.preprocessing.keep_interior = perpendicular::has_exact_partners;
  method.run = run_quadric;
  return method;
}

}  // namespace symsurf
