#include "methods.h"

#include <symsurf/errors.h>

namespace symsurf {

const std::vector<Method>& methods() {
  static const std::vector<Method> list{
      auto_method(),          plane_method(),         sphere_method(),
      cylinder_method(),      quadric_method(),       fixed_direction_method(),
      perpendicular_method(), separation_method(),    separation_normals_method(),
      normals_only_method(),  sphere_thesis_method(),
  };
  return list;
}

const Method& method(std::string_view name) {
  std::string names;
  for (const Method& candidate : methods()) {
    if (candidate.name == name) return candidate;
    names += (names.empty() ? "" : ", ") + candidate.name;
  }
  throw InvalidParameter("there is no method '" + std::string(name) + "'; there are " + names);
}

}  // namespace symsurf
