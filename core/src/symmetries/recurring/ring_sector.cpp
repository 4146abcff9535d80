#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/math.h"
#include "symmetries/recurring/connected_lines.h"

namespace symsurf {

namespace {

// The powers of the least turn of finite order. Lines that are not taken around to themselves have
// no image by the identity.
std::vector<LocalMatch> least_turn(const ConnectedLines& around,
                                   const std::vector<LocalMatch>& matches) {
  Index most = 2;
  std::vector<LocalMatch> ring;
  for (const LocalMatch& turn : matches) {
    if (turn.map.linear().determinant() < 0) continue;
    const double angle = Eigen::AngleAxisd(turn.map.linear()).angle();
    if (angle < same_turn) continue;
    const auto order = static_cast<Index>(std::round(2 * std::numbers::pi / angle));
    const double whole = static_cast<double>(order) * angle - 2 * std::numbers::pi;
    if (order <= most || std::abs(whole) > same_turn) continue;
    std::vector<LocalMatch> powers{matches.front()};
    while (static_cast<Index>(powers.size()) < order)
      powers.push_back(around.after(turn, powers.back()));
    const std::vector<std::int32_t> last = around.after(turn, powers.back()).images;
    if (last[0] != around.number(0)) continue;
    for (std::size_t line = 0; line < around.size(); ++line)
      if (last[line] != around.number(line)) powers.front().images[line] = -1;
    most = order;
    ring = std::move(powers);
  }
  return ring;
}

// The mean squared distance of lines from their centre.
double spread_of(const LocalLines& part, const ConnectedLines& around) {
  Vector3 centre = Vector3::Zero();
  for (const std::int32_t line : part) centre += around.middle(line);
  centre /= static_cast<double>(part.size());
  double sum = 0;
  for (const std::int32_t line : part) sum += (around.middle(line) - centre).squaredNorm();
  return sum / static_cast<double>(part.size());
}

}  // namespace

RingSector ring_sector(const ConnectedLines& around, const std::vector<LocalMatch>& matches) {
  RingSector found{{}, least_turn(around, matches)};
  if (found.turns.empty()) return found;
  std::vector<const LocalMatch*> turns;
  for (const LocalMatch& turn : found.turns) turns.push_back(&turn);
  const auto is_in_ring = [&](std::size_t line) { return found.turns.front().images[line] >= 0; };
  // Of the sectors that begin with a line each, the most compact one.
  constexpr double less = 1 - 1e-6;
  std::vector<char> seen(around.graph().lines.size(), 0);
  double least = infinity;
  for (std::size_t line = 0; line < around.size(); ++line) {
    if (!is_in_ring(line) || seen[around.number(line)]) continue;
    for (const LocalMatch& turn : found.turns) seen[turn.images[line]] = 1;
    LocalLines own = around.disjoint(turns, static_cast<std::int32_t>(line), around.middle(line));
    const double spread = spread_of(own, around);
    if (own.size() < found.lines.size() ||
        (own.size() == found.lines.size() && spread >= less * least))
      continue;
    least = spread;
    found.lines = std::move(own);
  }
  return found;
}

}  // namespace symsurf
