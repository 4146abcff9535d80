#include "registry.h"

#include "base/named_values.h"
#include "published/published.h"

namespace symsurf {

const std::vector<MethodImplementation>& implementations() {
  static const std::vector<MethodImplementation> list = [] {
    std::vector<MethodImplementation> all = heart_methods();
    for (MethodImplementation& each :
         with_shared_parameters({separation_method(), separation_normals_method(),
                                 normals_only_method(), sphere_thesis_method(), plane_icp_method(),
                                 plane_svd_method(), plane_hruda_method()}))
      all.push_back(std::move(each));
    return all;
  }();
  return list;
}

const MethodImplementation& implementation(std::string_view name) {
  return find_named(implementations(), name, "method");
}

const std::vector<Method>& methods() {
  static const std::vector<Method> descriptions(implementations().begin(), implementations().end());
  return descriptions;
}

const Method& method(std::string_view name) {
  return methods()[&implementation(name) - implementations().data()];
}

}  // namespace symsurf
