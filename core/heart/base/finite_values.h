#pragma once

#include <symsurf/parameter.h>

#include <cmath>
#include <map>
#include <type_traits>
#include <variant>

namespace symsurf {

/// Leaves out the figures that are not finite: what has no value is not reported.
inline void drop_nonfinite(Values& figures) {
  std::erase_if(figures, [](const auto& figure) {
    return std::visit(
        [](const auto& value) {
          using Held = std::decay_t<decltype(value)>;
          if constexpr (std::is_same_v<Held, double>)
            return !std::isfinite(value);
          else if constexpr (std::is_same_v<Held, Vector3> || std::is_same_v<Held, Eigen::MatrixXd>)
            return !value.allFinite();
          else
            return false;
        },
        figure.second);
  });
}

}  // namespace symsurf
