#pragma once

#include <symsurf/context.h>
#include <symsurf/parameter.h>

#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace symsurf {

/// The item of that name. Throws InvalidParameter, listing the names there are; `what`: "method".
template <typename Item>
const Item& find_named(const std::vector<Item>& items, std::string_view name, const char* what) {
  std::string names;
  for (const Item& item : items) {
    if (item.name == name) return item;
    names += (names.empty() ? "" : ", ") + item.name;
  }
  throw InvalidParameter("there is no " + std::string(what) + " '" + std::string(name) +
                         "'; there are " + names);
}

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
