#include "methods/common_parameters.h"

#include "score/verdict.h"

namespace symsurf {

Parameter surfels_searched(Index usual, const std::string& kind) {
  return Parameter::integer("sample_size", usual, 100, 100000, "points",
                            "Patches of the cloud that the search for " + kind + " works on.");
}

Parameter max_candidates(Index usual, Index most, const std::string& kinds) {
  return Parameter::integer("max_candidates", usual, 0, most, "",
                            "Other " + kinds + " to report at the most, best first.");
}

Parameter pair_distance(double usual) {
  return Parameter::real(
      "pair_distance", usual, 0, 1, "diagonal",
      "A point whose image has no point of the cloud nearer than this has no partner.");
}

Parameter pairs() {
  return Parameter::boolean("pairs", true,
                            "Whether each point gets its partner over the mirror; without them "
                            "the mirror and its score come sooner.");
}

Parameter minimum_score() {
  return Parameter::real("minimum_score", usual_minimum_score, 0, 1, "",
                         "Below it the verdict is \"none\": what was found is no symmetry of the "
                         "shape.");
}

Parameter tolerance() {
  return Parameter::real("tolerance", usual_tolerance, 1e-4, 0.1, "diagonal",
                         "How unlike the two sides may be: where an image lies so far from the "
                         "shape, across its surface, the score counts it half.");
}

}  // namespace symsurf
