#include "search/methods.h"

#include <algorithm>

#include "base/named_values.h"
#include "score/verdict.h"

namespace symsurf {

namespace {

// Those that do not, find the pairs first, and the mirror through them.
bool pairs_over_mirror(const Method& method) {
  return method.name == "auto" ||
         std::any_of(method.parameters.begin(), method.parameters.end(),
                     [](const Parameter& p) { return p.name == "pair_distance"; });
}

}  // namespace

std::vector<MethodImplementation> with_shared_parameters(
    std::vector<MethodImplementation> methods) {
  for (MethodImplementation& each : methods) {
    if (pairs_over_mirror(each)) each.parameters.push_back(pairs());
    each.parameters.push_back(minimum_score());
    each.parameters.push_back(tolerance());
  }
  return methods;
}

const std::vector<MethodImplementation>& heart_methods() {
  static const std::vector<MethodImplementation> all = with_shared_parameters(
      {auto_method(), plane_method(), oblique_plane_method(), sphere_method(), cylinder_method(),
       quadric_method(), fixed_direction_method(), perpendicular_method()});
  return all;
}

const MethodImplementation& heart_method(std::string_view name) {
  return find_named(heart_methods(), name, "method");
}

Parameter surfels_searched(Index usual, const std::string& kind) {
  return Parameter::integer(
      "sample_size", usual, 100, 100000, "points",
      "Number of surface patches (surfels) used by the search for " + kind + ".");
}

Parameter max_candidates(Index usual, Index most, const std::string& kinds) {
  return Parameter::integer("max_candidates", usual, 0, most, "",
                            "Maximum number of other " + kinds + " to report, best first.");
}

Parameter pair_distance(double usual) {
  return Parameter::real("pair_distance", usual, 0, 1, "diagonal",
                         "Maximum distance between the image of a point and its partner.");
}

Parameter pairs() {
  return Parameter::boolean(
      "pairs", true, "Whether to find the partner of each point; omitting the pairs is faster.");
}

Parameter minimum_score() {
  return Parameter::real("minimum_score", usual_minimum_score, 0, 1, "",
                         "Score below which the verdict is \"none\": the mirror that was found is "
                         "no symmetry of the shape.");
}

Parameter tolerance() {
  return Parameter::real("tolerance", usual_tolerance, 1e-4, 0.1, "diagonal",
                         "How far the two sides may differ and still count as symmetric: a point "
                         "whose image lies this far from the surface counts half in the score.");
}

}  // namespace symsurf
