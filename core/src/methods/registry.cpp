#include "methods/registry.h"

#include <algorithm>

#include "base/find_named.h"
#include "methods/common_parameters.h"

namespace symsurf {

namespace {

// Those that do not, find the pairs first, and the mirror through them.
bool pairs_over_mirror(const Method& method) {
  return method.name == "auto" ||
         std::any_of(method.parameters.begin(), method.parameters.end(),
                     [](const Parameter& p) { return p.name == "pair_distance"; });
}

}  // namespace

const std::vector<MethodImplementation>& implementations() {
  static const std::vector<MethodImplementation> list = [] {
    std::vector<MethodImplementation> all{
        auto_method(),          plane_method(),         sphere_method(),
        cylinder_method(),      quadric_method(),       fixed_direction_method(),
        perpendicular_method(), separation_method(),    separation_normals_method(),
        normals_only_method(),  sphere_thesis_method(), plane_icp_method(),
        plane_svd_method(),     plane_hruda_method(),
    };
    for (MethodImplementation& each : all) {
      if (pairs_over_mirror(each)) each.parameters.push_back(pairs());
      each.parameters.push_back(minimum_score());
      each.parameters.push_back(tolerance());
    }
    return all;
  }();
  return list;
}

const std::vector<Method>& methods() {
  static const std::vector<Method> descriptions(implementations().begin(), implementations().end());
  return descriptions;
}

const MethodImplementation& implementation(std::string_view name) {
  return find_named(implementations(), name, "method");
}

const Method& method(std::string_view name) {
  return methods()[&implementation(name) - implementations().data()];
}

}  // namespace symsurf
