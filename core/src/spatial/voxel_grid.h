#pragma once

#include <symsurf/points.h>

#include <bit>
#include <cstdint>
#include <vector>

namespace symsurf {

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
  using Words = std::vector<std::uint64_t>;

  OccupiedVoxels() = default;
  explicit OccupiedVoxels(const VoxelGrid& grid) : VoxelGrid(grid), words_(size() / bits + 1) {}

  void occupy(const Cell& c) { words_[index(c) / bits] |= bit(index(c)); }

  /// The same voxels as another of the same grid.
  void occupy(const Words& words) {
    for (std::size_t w = 0; w < words.size(); ++w) words_[w] |= words[w];
  }
  const Words& words() const { return words_; }

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

  Words words_;
  std::vector<std::int32_t> before_;  // each word
  Index count_ = 0;
};

}  // namespace symsurf
