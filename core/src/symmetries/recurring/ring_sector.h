#pragma once

#include <vector>

#include "symmetries/recurring/connected_lines.h"

namespace symsurf {

/// Radians: turns that differ by less are one.
inline constexpr double same_turn = 0.02;

/// A sector of a ring: lines that a turn by an n-th of a circle takes around an axis, as that of a
/// gear takes a tooth.
struct RingSector {
  LocalLines lines;               ///< of one sector; none: there is no ring
  std::vector<LocalMatch> turns;  ///< the powers of the turn, the identity first
};

/// The sector of the least such turn, by a third of a circle or less, among the matches. The first
/// of these is the identity.
RingSector ring_sector(const ConnectedLines& around, const std::vector<LocalMatch>& matches);

}  // namespace symsurf
