#pragma once

#include <symsurf/types.h>

#include <bit>
#include <cstdint>
#include <vector>

namespace symsurf {

/// Which cells of a grid are occupied, numbered in their order: a bit a cell and the sum of the
/// bits before each word (Jacobson, "Space-efficient static trees and graphs", 1989).
class OccupiedCells {
 public:
  using Words = std::vector<std::uint64_t>;

  explicit OccupiedCells(Index cells = 0) : words_(cells / bits + 1) {}

  void add(Index cell) { words_[cell / bits] |= bit(cell); }

  /// Those of another of the same size.
  void add(const Words& words) {
    for (std::size_t w = 0; w < words.size(); ++w) words_[w] |= words[w];
  }

  const Words& words() const { return words_; }

  /// To be called when all are added, and before any is asked for.
  void number_them() {
    before_.clear();
    count_ = 0;
    for (const std::uint64_t word : words_) {
      before_.push_back(static_cast<std::int32_t>(count_));
      count_ += std::popcount(word);
    }
  }

  Index count() const { return count_; }

  /// How many there are before this one, up to the cell past the last.
  Index before(Index cell) const {
    return before_[cell / bits] + std::popcount(words_[cell / bits] & (bit(cell) - 1));
  }

  /// -1: it is not occupied.
  Index number(Index cell) const { return words_[cell / bits] & bit(cell) ? before(cell) : -1; }

 private:
  static constexpr Index bits = 64;
  static std::uint64_t bit(Index cell) { return std::uint64_t{1} << (cell % bits); }

  Words words_;
  std::vector<std::int32_t> before_;  // each word
  Index count_ = 0;
};

}  // namespace symsurf
