#include <symsurf/placement.h>

#include <map>

namespace symsurf {

const Placement& placement(std::string_view parameter) {
  static constexpr Placement rare{"", true};
  static constexpr Placement pairs{"Pairs"};
  static constexpr Placement acceptance{"Acceptance"};
  static constexpr Placement counterparts{"Counterparts"};
  static constexpr Placement axis{"Axis", false, "symmetry", "axis"};
  static constexpr Placement computing{"Computing", true};

  static const std::map<std::string_view, Placement> placements{
      {"pairs", {"Pairs", true}},
      {"pair_distance", pairs},
      {"minimum_score", acceptance},
      {"tolerance", acceptance},
      {"require_found", rare},
      {"pairing", counterparts},
      {"one_to_one", counterparts},
      {"max_distance", counterparts},
      {"max_angle", counterparts},
      {"axis_point", axis},
      {"axis_direction", axis},
      {"axis_order", axis},
      // How much a search looks at: the defaults do for shapes of any size.
      {"sample_size", rare},
      {"max_candidates", rare},
      {"starts", rare},
      {"draws", rare},
      {"paired_points", rare},
      {"disc", rare},
      {"points", rare},
      {"localization", rare},
      {"power", rare},
      {"resolution", rare},
      {"functions", rare},
      {"seed", computing},
      {"threads", computing},
  };
  static const Placement usual;
  const auto found = placements.find(parameter);
  return found == placements.end() ? usual : found->second;
}

}  // namespace symsurf
