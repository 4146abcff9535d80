#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace symsurf {

/// The value with `share`, 0 <= share < 1, of the values before it in order; of at least one value.
template <typename T>
T quantile(std::vector<T> values, double share) {
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// The middle value; of an even number the upper one.
template <typename T>
T median(std::vector<T> values) {
  return quantile(std::move(values), 0.5);
}

}  // namespace symsurf
