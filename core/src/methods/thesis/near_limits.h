#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/vectorised.h"
#include "methods/thesis/block_search.h"

namespace symsurf {

/// Lowers the limits to these squared distances and `slack` beyond; false where all are too far.
inline __attribute__((always_inline)) bool lower_to(const Floats& squared, float slack,
                                                    BlockQueries::Limits& limits) {
  const Ints is_near = squared <= *reinterpret_cast<const Floats*>(&limits);
  std::array<std::uint64_t, 4> words;
  std::memcpy(&words, &is_near, sizeof words);
  if (!(words[0] | words[1] | words[2] | words[3])) return false;
  BlockQueries::Limits least;
  *reinterpret_cast<Floats*>(&least) = squared;
  for (int q = 0; q < BlockQueries::block; ++q) {
    const float reach = std::sqrt(least[q]) + slack;
    limits[q] = std::min(limits[q], reach * reach);
  }
  return true;
}

}  // namespace symsurf
