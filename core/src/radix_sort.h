#pragma once

#include <cstdint>
#include <vector>

namespace symsurf {

/// Sorts `order` by `keys` (one each, sorted along), stably; a digit that all keys share costs no
/// pass.
void radix_sort(std::vector<std::uint64_t>& keys, std::vector<std::int32_t>& order);

}  // namespace symsurf
