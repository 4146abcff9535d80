#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace symsurf {

/// The number whose bytes stand at `bytes` in the given order.
template <typename T>
T load(const char* bytes, std::endian order) {
  std::array<char, sizeof(T)> native;
  std::memcpy(native.data(), bytes, sizeof(T));
  if (order != std::endian::native) std::reverse(native.begin(), native.end());
  return std::bit_cast<T>(native);
}

}  // namespace symsurf
