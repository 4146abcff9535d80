#pragma once

#include <symsurf/context.h>

#include <cstdint>
#include <vector>

namespace symsurf {

/// Sorts `order` by `keys` (one each, sorted along), stably; a digit that all keys share costs no
/// pass. Asks the context whether to go on.
void radix_sort(std::vector<std::uint64_t>& keys, std::vector<std::int32_t>& order,
                const Context& context);

}  // namespace symsurf
