#pragma once

#include <symsurf/types.h>

#include <bit>
#include <cstdint>

namespace symsurf {

/// The same for copies, all but surely another for others (the finaliser of MurmurHash3).
inline std::uint64_t hash_of(const Vector3& x) {
  std::uint64_t mixed = 0;
  for (const double coordinate : {x.x(), x.y(), x.z()}) {
    mixed = (mixed ^ std::bit_cast<std::uint64_t>(coordinate + 0.0)) * 0xff51afd7ed558ccdu;
    mixed = (mixed ^ mixed >> 33) * 0xc4ceb9fe1a85ec53u;
    mixed ^= mixed >> 33;
  }
  return mixed;
}

/// Chooses that share of points by their hashes: whatever their order, and copies together.
inline bool is_chosen(std::uint64_t hash, double share) {
  return hash >> 32 <= static_cast<std::uint64_t>(share * 0xffffffffu);
}

}  // namespace symsurf
