#pragma once

#include <symsurf/context.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

#include "base/parallel.h"

namespace symsurf {

/// Sorts `order` by `keys` (one each, sorted along), stably; a digit that all keys share costs no
/// pass. Asks the context whether to go on.
inline void radix_sort(std::vector<std::uint64_t>& keys, std::vector<std::int32_t>& order,
                       const Context& context) {
  constexpr int digit_bits = 11, digits = 6, buckets = 1 << digit_bits;
  std::vector<std::array<std::size_t, buckets>> counts(digits);
  for (auto& count : counts) count.fill(0);
  const auto count = static_cast<Index>(keys.size());
  interruptible_for(context, count, [&](Index i) {
    for (int d = 0; d < digits; ++d) ++counts[d][keys[i] >> (digit_bits * d) & (buckets - 1)];
  });

  std::vector<std::uint64_t> keys_to(keys.size());
  std::vector<std::int32_t> order_to(keys.size());
  for (int d = 0; d < digits; ++d) {
    auto& start = counts[d];
    if (*std::max_element(start.begin(), start.end()) == keys.size()) continue;
    std::exclusive_scan(start.begin(), start.end(), start.begin(), std::size_t{0});
    interruptible_for(context, count, [&](Index i) {
      const std::size_t to = start[keys[i] >> (digit_bits * d) & (buckets - 1)]++;
      keys_to[to] = keys[i];
      order_to[to] = order[i];
    });
    keys.swap(keys_to);
    order.swap(order_to);
  }
}

}  // namespace symsurf
