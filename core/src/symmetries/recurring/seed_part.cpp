#include "symmetries/recurring/seed_part.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <queue>
#include <unordered_set>

#include "base/math.h"

namespace symsurf {

namespace {

// Lines that make up a part; where other lines go on from it more: the sides of a prism or cube are
// none.
constexpr std::size_t least_lines = 3, least_lines_of_piece = 5;

// Of what the best candidate saves: another, that is a whole or has
// more instances, comes before it down to this.
constexpr double nearly_best = 0.75;

// Radians: turns that are one.
constexpr double same_turn = 0.02;

// Matches by how much of the seed's surroundings they hold; each level is tried.
constexpr std::size_t most_levels = 40;

// Of the table of images: so many entries are 64 MB.
constexpr std::size_t most_entries = std::size_t{1} << 24;

using Images = std::vector<std::int32_t>;  // of each local line; -1: none

// A map with where it takes the lines that are connected with the seed.
struct LocalMatch {
  Eigen::Isometry3d map;
  Images images;
  double length = 0;
};

class PartOfSeed {
 public:
  PartOfSeed(Index seed, const FeatureLines& graph) : seed_(seed), graph_(graph) {}

  RecurringPart run(const std::vector<Index>& alike, const LineMatching& matching,
                    const Context& context) {
    if (!collect(alike, matching, context)) return {};
    consider_levels([](const LocalMatch&) { return true; });
    consider_levels([](const LocalMatch& match) {
      return (match.map.linear() - Matrix3::Identity()).norm() < same_turn;
    });
    // A whole that recurs is a part, and no ring of its sectors.
    if (std::none_of(candidates_.begin(), candidates_.end(),
                     [&](const RecurringPart& part) { return part.lines.size() == lines_.size(); }))
      consider_ring();
    const auto best = best_part(candidates_);
    return best == candidates_.end() ? RecurringPart() : std::move(*best);
  }

 private:
  // Local numbers: 0 is the seed, then its surroundings in the order in which they are reached.
  bool collect(const std::vector<Index>& alike, const LineMatching& matching,
               const Context& context) {
    const auto own = matching.grown(seed_, seed_, {false, false});
    if (!own || own->lines.size() < least_lines) return false;
    local_.assign(graph_.lines.size(), -1);
    for (const auto& [line, image] : own->lines) {
      local_[line] = static_cast<std::int32_t>(lines_.size());
      lines_.push_back(line);
    }
    add(*own);
    for (const Index other : alike)
      for (const bool reversed : {false, true})
        for (const bool reflected : {false, true}) {
          context.check();
          if (other == seed_ && !reversed && !reflected) continue;
          if (matches_.size() * lines_.size() > most_entries) return true;
          const auto match = matching.grown(seed_, other, {reversed, reflected});
          if (match && match->lines.size() >= least_lines) add(*match);
        }
    std::vector<double> plainness;
    for (const LocalMatch& match : matches_)
      plainness.push_back(LineMatch{match.map, {}}.plainness());
    std::vector<std::size_t> order(matches_.size());
    std::iota(order.begin(), order.end(), 0);
    constexpr double rounding = 1e-6;
    std::stable_sort(order.begin() + 1, order.end(), [&](std::size_t a, std::size_t b) {
      return std::round(plainness[a] / rounding) > std::round(plainness[b] / rounding);
    });
    std::vector<LocalMatch> sorted;
    for (const std::size_t k : order) sorted.push_back(std::move(matches_[k]));
    matches_ = std::move(sorted);
    return matches_.size() > 1;
  }

  void add(const LineMatch& match) {
    LocalMatch local{match.map, Images(lines_.size(), -1)};
    for (const auto& [line, image] : match.lines) {
      local.images[local_[line]] = static_cast<std::int32_t>(image);
      local.length += graph_.lines[line].length;
    }
    matches_.push_back(std::move(local));
  }

  // The lines connected with the seed among those that `is_in` (of local numbers) has.
  template <typename IsIn>
  std::vector<std::int32_t> connected(const IsIn& is_in) const {
    std::vector<std::int32_t> found;
    std::vector<char> seen(lines_.size(), 0);
    const auto visit = [&](std::int32_t line) {
      if (line < 0 || seen[line]) return;
      seen[line] = 1;
      if (is_in(line)) found.push_back(line);
    };
    visit(0);
    for (std::size_t k = 0; k < found.size(); ++k) for_each_next(found[k], visit);
    return found;
  }

  template <typename Visit>
  void for_each_next(std::int32_t line, const Visit& visit) const {
    for (const Index corner : {graph_.lines[lines_[line]].start, graph_.lines[lines_[line]].end})
      for (const Index next : graph_.at[corner]) visit(local_[next]);
  }

  // What all of the matches that hold at least so much have in common, level by level.
  template <typename Chosen>
  void consider_levels(const Chosen& chosen) {
    std::vector<double> levels;
    for (const LocalMatch& match : matches_)
      if (chosen(match)) levels.push_back(match.length);
    std::sort(levels.rbegin(), levels.rend());
    constexpr double same_level = 0.98;
    std::vector<double> kept;
    for (std::size_t k = 0; k + 1 <= levels.size(); ++k)
      if (k + 1 == levels.size() || levels[k + 1] < same_level * levels[k])
        kept.push_back(levels[k]);
    const std::size_t stride = kept.size() / most_levels + 1;
    for (std::size_t k = 0; k < kept.size(); k += stride) {
      std::vector<const LocalMatch*> level;
      for (const LocalMatch& match : matches_)
        if (chosen(match) && match.length >= kept[k]) level.push_back(&match);
      consider(connected([&](std::int32_t line) {
                 return std::all_of(level.begin(), level.end(), [&](const LocalMatch* match) {
                   return match->images[line] >= 0;
                 });
               }),
               matches_);
      consider(shared(level, 0, graph_.lines[seed_].middle()), matches_);
    }
  }

  // What surrounds a line, first what is nearer to a point, whose images by these maps are all
  // there and no line twice.
  std::vector<std::int32_t> shared(const std::vector<const LocalMatch*>& matches,
                                   std::int32_t start, const Vector3& middle) const {
    using Step = std::pair<double, std::int32_t>;
    std::priority_queue<Step, std::vector<Step>, std::greater<>> steps;
    std::vector<char> seen(lines_.size(), 0), claimed(graph_.lines.size(), 0);
    const auto visit = [&](std::int32_t line) {
      if (line < 0 || seen[line]) return;
      seen[line] = 1;
      steps.push({(graph_.lines[lines_[line]].middle() - middle).norm(), line});
    };
    std::vector<std::int32_t> part;
    visit(start);
    while (!steps.empty()) {
      const std::int32_t line = steps.top().second;
      steps.pop();
      std::size_t fresh = 0;
      for (const LocalMatch* match : matches) {
        const std::int32_t image = match->images[line];
        if (image < 0 || claimed[image]) break;
        claimed[image] = 1;
        ++fresh;
      }
      if (fresh < matches.size()) {
        for (std::size_t k = 0; k < fresh; ++k) claimed[matches[k]->images[line]] = 0;
        continue;
      }
      part.push_back(line);
      for_each_next(line, visit);
    }
    return part;
  }

  // The least turn by an n-th of a circle that takes the surroundings around an axis.
  void consider_ring() {
    Index most = 2;
    std::vector<LocalMatch> ring;
    for (const LocalMatch& turn : matches_) {
      if (turn.map.linear().determinant() < 0) continue;
      const double angle = Eigen::AngleAxisd(turn.map.linear()).angle();
      if (angle < same_turn) continue;
      const auto order = static_cast<Index>(std::round(2 * std::numbers::pi / angle));
      const double whole = static_cast<double>(order) * angle - 2 * std::numbers::pi;
      if (order <= most || std::abs(whole) > same_turn) continue;
      std::vector<LocalMatch> powers{matches_.front()};
      while (static_cast<Index>(powers.size()) < order)
        powers.push_back(after(turn, powers.back()));
      const Images last = after(turn, powers.back()).images;
      if (last[0] != lines_[0]) continue;
      for (std::size_t line = 0; line < lines_.size(); ++line)
        if (last[line] != lines_[line]) powers.front().images[line] = -1;
      most = order;
      ring = std::move(powers);
    }
    if (ring.empty()) return;
    std::vector<const LocalMatch*> powers;
    for (const LocalMatch& power : ring) powers.push_back(&power);
    // A sector begins with what stands out from the axis, as the tip of a tooth does: with what
    // gives the most compact one.
    const auto middle = [&](std::size_t line) { return graph_.lines[lines_[line]].middle(); };
    const auto is_in_ring = [&](std::size_t line) { return ring.front().images[line] >= 0; };
    const auto chord = [&](std::size_t line) {
      return (ring[1].map * middle(line) - middle(line)).norm();
    };
    double farthest = 0, nearest = infinity;
    for (std::size_t line = 0; line < lines_.size(); ++line)
      if (is_in_ring(line)) {
        farthest = std::max(farthest, chord(line));
        nearest = std::min(nearest, chord(line));
      }
    constexpr double stands_out = 0.75, less = 1 - 1e-6;
    const double far = nearest + stands_out * (farthest - nearest);
    std::vector<char> seen(graph_.lines.size(), 0);
    std::vector<std::int32_t> sector;
    double least = infinity;
    for (std::size_t line = 0; line < lines_.size(); ++line) {
      if (!is_in_ring(line) || seen[lines_[line]] || chord(line) < far) continue;
      for (const LocalMatch& power : ring) seen[power.images[line]] = 1;
      // Of what lies as near on both of its sides, that on the same one is taken.
      constexpr double aside = 0.05;  // of the distance to the next sector
      const Vector3 tip = middle(line);
      std::vector<std::int32_t> own =
          shared(powers, static_cast<std::int32_t>(line), tip + aside * (ring[1].map * tip - tip));
      const double spread = spread_of(own);
      if (own.size() < sector.size() || (own.size() == sector.size() && spread >= less * least))
        continue;
      least = spread;
      sector = std::move(own);
    }
    consider(sector, ring);
  }

  // The mean squared distance of lines from their centre.
  double spread_of(const std::vector<std::int32_t>& part) const {
    Vector3 centre = Vector3::Zero();
    for (const std::int32_t line : part) centre += graph_.lines[lines_[line]].middle();
    centre /= static_cast<double>(part.size());
    double sum = 0;
    for (const std::int32_t line : part)
      sum += (graph_.lines[lines_[line]].middle() - centre).squaredNorm();
    return sum / static_cast<double>(part.size());
  }

  // First one map, then the other.
  LocalMatch after(const LocalMatch& second, const LocalMatch& first) const {
    LocalMatch both{second.map * first.map, Images(lines_.size(), -1)};
    for (std::size_t line = 0; line < lines_.size(); ++line) {
      const std::int32_t image = first.images[line], own = image < 0 ? -1 : local_[image];
      if (own >= 0) both.images[line] = second.images[own];
    }
    return both;
  }

  // A part of these lines: as many instances as do not share a line, of maps in their order.
  void consider(const std::vector<std::int32_t>& part, const std::vector<LocalMatch>& maps) {
    const bool is_whole = part.size() == lines_.size();
    if (part.size() < (is_whole ? least_lines : least_lines_of_piece)) return;
    RecurringPart found;
    found.is_whole = is_whole;
    std::vector<char> claimed(graph_.lines.size(), 0);
    for (const LocalMatch& match : maps) {
      RecurringPart::Instance instance{match.map, {}};
      for (const std::int32_t line : part) {
        const std::int32_t image = match.images[line];
        if (image < 0 || claimed[image]) break;
        instance.lines.push_back(image);
      }
      if (instance.lines.size() < part.size()) continue;
      for (const Index image : instance.lines) claimed[image] = 1;
      found.instances.push_back(std::move(instance));
    }
    for (const std::int32_t line : part) {
      found.lines.push_back(lines_[line]);
      found.length += graph_.lines[lines_[line]].length;
    }
    // A pair is one only as a whole: of two halves of a body all lines go on to the other.
    const std::size_t least = is_whole ? 2 : 3;
    if (found.instances.size() >= least && !is_halved(found))
      candidates_.push_back(std::move(found));
  }

  // Whether a reflection or half-turn takes the first instance to one that it touches, or that a
  // line joins it to: these are halves of a part that is symmetric.
  bool is_halved(const RecurringPart& part) const {
    std::unordered_set<Index> own;
    for (const Index line : part.lines)
      for (const Index corner : {graph_.lines[line].start, graph_.lines[line].end})
        if (corner >= 0)
          for (const Index next : graph_.at[corner])
            own.insert({graph_.lines[next].start, graph_.lines[next].end});
    return std::any_of(
        part.instances.begin() + 1, part.instances.end(),
        [&](const RecurringPart::Instance& instance) {
          const Eigen::Isometry3d twice = instance.map * instance.map;
          const Vector3 middle = graph_.lines[seed_].middle();
          return (twice.linear() - Matrix3::Identity()).norm() < 2 * same_turn &&
                 (twice * middle - middle).norm() < same_turn * part.length &&
                 std::any_of(instance.lines.begin(), instance.lines.end(), [&](Index line) {
                   return own.count(graph_.lines[line].start) || own.count(graph_.lines[line].end);
                 });
        });
  }

  Index seed_;
  const FeatureLines& graph_;
  std::vector<std::int32_t> local_;  // of each line; -1: not connected with the seed
  std::vector<Index> lines_;         // of each local one
  std::vector<LocalMatch> matches_;  // the identity first
  std::vector<RecurringPart> candidates_;
};

}  // namespace

std::vector<RecurringPart>::iterator best_part(std::vector<RecurringPart>& parts) {
  double most = 0;
  for (const RecurringPart& part : parts) most = std::max(most, part.saved());
  const auto comes_before = [](const RecurringPart& a, const RecurringPart& b) {
    constexpr double more = 1 + 1e-9;
    if (a.is_whole != b.is_whole) return a.is_whole;
    if (a.instances.size() != b.instances.size()) return a.instances.size() > b.instances.size();
    return a.saved() > more * b.saved();
  };
  auto best = parts.end();
  for (auto part = parts.begin(); part != parts.end(); ++part)
    if (part->saved() >= nearly_best * most && (best == parts.end() || comes_before(*part, *best)))
      best = part;
  return best;
}

RecurringPart seed_part(Index seed, const std::vector<Index>& alike, const FeatureLines& graph,
                        const LineMatching& matching, const Context& context) {
  return PartOfSeed(seed, graph).run(alike, matching, context);
}

}  // namespace symsurf
