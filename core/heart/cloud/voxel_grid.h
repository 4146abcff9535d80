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

/// Cubic voxels over a box, indexed along z, then y, then x.
class VoxelGrid {
 public:
  using Cell = Eigen::Vector3i;

  VoxelGrid() = default;

  VoxelGrid(const Vector3& low, const Vector3& high, double edge)
      // Off any lattice that the points may lie on: rounding must not decide between two voxels.
      : VoxelGrid(FromCorner(), low.array() - 0.38197 * edge, high, edge) {}

  /// Whose first voxel begins at the corner.
  static VoxelGrid from_corner(const Vector3& corner, const Vector3& high, double edge) {
    return {FromCorner(), corner, high, edge};
  }

  double edge() const { return edge_; }
  const Vector3& low() const { return low_; }

  /// How many voxels there are.
  Index size() const { return size_.cast<Index>().prod(); }

  /// Of points beside the box the nearest.
  Cell cell_of(const Vector3& x) const {
    return ((x - low_) * per_unit_).cast<int>().cwiseMax(0).cwiseMin(size_ - Cell::Ones());
  }
  Vector3 middle(const Cell& c) const {
    return low_ + edge_ * (c.cast<double>().array() + 0.5).matrix();
  }

  Index index(const Cell& c) const {
    return (static_cast<Index>(c.x()) * size_.y() + c.y()) * size_.z() + c.z();
  }
  Cell cell(Index index) const {
    const Index row = index / size_.z();
    return Vector3(row / size_.y(), row % size_.y(), index % size_.z()).cast<int>();
  }

  /// -1 beside the box.
  Index index_at(const Vector3& x) const {
    const Vector3 at = (x - low_) * per_unit_;
    if (!((at.array() >= 0).all() && (at.array() < size_.cast<double>().array()).all())) return -1;
    return index(at.cast<int>());
  }

  /// Calls visit(begin, end) for the rows of indices of the voxels within so many steps of this.
  template <typename Visit>
  void for_each_row_around(const Cell& c, int steps, const Visit& visit) const {
    const Cell from = (c.array() - steps).max(0), to = (c.array() + steps).min(size_.array() - 1);
    for (int x = from.x(); x <= to.x(); ++x)
      for (int y = from.y(); y <= to.y(); ++y) {
        const Index row = index({x, y, 0});
        visit(row + from.z(), row + to.z() + 1);
      }
  }

  /// Calls visit(index) for this voxel and those that touch it.
  template <typename Visit>
  void for_each_touching(Index index, const Visit& visit) const {
    for_each_row_around(cell(index), 1, [&](Index begin, Index end) {
      for (Index k = begin; k < end; ++k) visit(k);
    });
  }

 private:
  struct FromCorner {};
  VoxelGrid(FromCorner, const Vector3& corner, const Vector3& high, double edge)
      : low_(corner),
        edge_(edge),
        per_unit_(1 / edge),
        size_(((high - low_) * per_unit_).array().floor().cast<int>() + 1) {}

  Vector3 low_ = Vector3::Zero();
  double edge_ = 1, per_unit_ = 1;
  Cell size_ = Cell::Zero();
};

/// A voxel grid whose occupied voxels are numbered in the order of their indices: a bit a voxel and
/// the sum of the bits before each word (Jacobson, "Space-efficient static trees and graphs",
/// 1989).
class OccupiedVoxels : public VoxelGrid {
 public:
  OccupiedVoxels() = default;
  explicit OccupiedVoxels(const VoxelGrid& grid) : VoxelGrid(grid), words_(size() / bits + 1) {}

  void occupy(const Cell& c) { words_[index(c) / bits] |= bit(index(c)); }

  /// To be called when all are occupied, and before any is asked for.
  void number_them() {
    before_.clear();
    count_ = 0;
    for (const std::uint64_t word : words_) {
      before_.push_back(static_cast<std::int32_t>(count_));
      count_ += std::popcount(word);
    }
  }

  /// How many are occupied.
  Index count() const { return count_; }

  /// -1: not occupied.
  Index number(const Cell& c) const { return number_of(index(c)); }

  /// Of the voxel that holds x; -1 where that is not occupied, or x beside the box.
  Index number_at(const Vector3& x) const {
    const Index index = index_at(x);
    return index < 0 ? -1 : number_of(index);
  }

  /// Calls visit(number) for the occupied voxels that touch this one, and itself if it is.
  template <typename Visit>
  void for_each_occupied_touching(const Cell& c, const Visit& visit) const {
    for_each_row_around(c, 1, [&](Index begin, Index end) {
      const Index last = before(end);
      for (Index k = before(begin); k < last; ++k) visit(k);
    });
  }

 private:
  static constexpr Index bits = 64;
  static std::uint64_t bit(Index index) { return std::uint64_t{1} << (index % bits); }

  // How many occupied ones there are before this, up to the one past the last.
  Index before(Index index) const {
    return before_[index / bits] + std::popcount(words_[index / bits] & (bit(index) - 1));
  }
  Index number_of(Index index) const {
    return words_[index / bits] & bit(index) ? before(index) : -1;
  }

  std::vector<std::uint64_t> words_;
  std::vector<std::int32_t> before_;  // each word
  Index count_ = 0;
};

}  // namespace symsurf
