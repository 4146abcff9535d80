#pragma once

#include <symsurf/points.h>

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

namespace symsurf {

/// Three integers that are looked up together: a grid cell, or the bits of a point.
using Triple = std::array<std::int64_t, 3>;

/// By the finaliser of MurmurHash3: bits of points differ in the high digits only, cells in the low
/// ones.
inline std::uint64_t hash_of(const Triple& triple) {
  std::uint64_t mixed = 0;
  for (const std::int64_t v : triple) {
    mixed = (mixed ^ static_cast<std::uint64_t>(v)) * 0xff51afd7ed558ccdu;
    mixed = (mixed ^ mixed >> 33) * 0xc4ceb9fe1a85ec53u;
    mixed ^= mixed >> 33;
  }
  return mixed;
}

/// The same for copies of a point, all but surely another for others.
inline std::uint64_t hash_of(const Vector3& x) {
  Triple bits;
  for (int axis = 0; axis < 3; ++axis) bits[axis] = std::bit_cast<std::int64_t>(x[axis] + 0.0);
  return hash_of(bits);
}

/// Chooses that share of points by their hashes: whatever their order, and copies together.
inline bool is_chosen(std::uint64_t hash, double share) {
  return hash >> 32 <= static_cast<std::uint64_t>(share * 0xffffffffu);
}

/// The bits of a point, ordered as its coordinates are; 0 and -0 give the same.
inline Triple ordered_bits(const Vector3& x) {
  Triple triple;
  for (int axis = 0; axis < 3; ++axis) {
    const auto v = std::bit_cast<std::int64_t>(x[axis] + 0.0);
    triple[axis] = v < 0 ? v ^ std::numeric_limits<std::int64_t>::max() : v;
  }
  return triple;
}

/// Numbers distinct triples 0, 1, 2, ... in the order of their first appearance.
/// A hash table with open addressing; at most 2^31 triples.
class TripleIndex {
 public:
  TripleIndex() : slots_(64, -1) {}

  Index size() const { return static_cast<Index>(triples_.size()); }
  const Triple& operator[](Index number) const { return triples_[number]; }

  /// The number of the triple, a new one if it is new.
  Index add(const Triple& triple) {
    const std::size_t slot = find(triple);
    if (slots_[slot] >= 0) return slots_[slot];
    slots_[slot] = static_cast<std::int32_t>(triples_.size());
    triples_.push_back(triple);
    if (2 * triples_.size() > slots_.size()) grow();
    return size() - 1;
  }

 private:
  std::size_t find(const Triple& triple) const {
    const std::size_t last = slots_.size() - 1;
    std::size_t slot = hash_of(triple) & last;
    while (slots_[slot] >= 0 && triples_[slots_[slot]] != triple) slot = (slot + 1) & last;
    return slot;
  }

  void grow() {
    slots_.assign(4 * slots_.size(), -1);
    for (std::size_t i = 0; i < triples_.size(); ++i)
      slots_[find(triples_[i])] = static_cast<std::int32_t>(i);
  }

  std::vector<std::int32_t> slots_;  // a power of two of them; -1: free
  std::vector<Triple> triples_;
};

}  // namespace symsurf
