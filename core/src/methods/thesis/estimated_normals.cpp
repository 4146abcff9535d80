#include "methods/thesis/estimated_normals.h"

#include "cloud/tree_normals.h"

namespace symsurf {

std::vector<Parameter> normal_parameters() {
  return {
      Parameter::integer("neighbours", 10, 3, 1000, "points",
                         "Nearest points, the point itself among them, that a "
                         "normal is estimated "
                         "from."),
      Parameter::choice("normal_estimation", "pca", {"pca", "regression"},
                        "How normals are estimated: by least variance, or by "
                        "regression of z on x "
                        "and y, which breaks on vertical patches."),
  };
}

Points given_or_estimated_normals(const Cloud& cloud, const PointTree& tree,
                                  const ParameterValues& values, const Context& context) {
  if (!cloud.normals.empty()) {
    Points unit(cloud.normals.size(), 3);
    for (Index i = 0; i < unit.rows(); ++i)
      unit.row(i) = cloud.normals[i].stableNormalized().transpose();
    return unit;
  }
  return estimate_normals(cloud.points, tree, values.integer("neighbours"),
                          values.choice("normal_estimation"), context);
}

bool signed_normals(const Cloud& cloud, const ParameterValues& values) {
  return cloud.normals.empty() && values.choice("normal_estimation") == "regression";
}

}  // namespace symsurf
