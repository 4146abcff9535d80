#pragma once

#include <cstdint>

namespace symsurf {

/// The bytes of memory that the process may have: the machine's, or less where it is limited.
std::uintmax_t memory_limit();

}  // namespace symsurf
