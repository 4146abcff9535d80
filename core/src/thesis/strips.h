#pragma once

#include <symsurf/context.h>
#include <symsurf/types.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace symsurf {

/// Places in a plane, -1 to 1.
struct Places {
  std::vector<float> u, v;

  Index size() const { return static_cast<Index>(u.size()); }
  void resize(Index count) {
    u.resize(count);
    v.resize(count);
  }
};

/// More than the rounding of any distance between places.
constexpr float place_rounding = 2e-6f;

/// Places sorted into strips of equal height in v and, to within a cell, by u along each: what lies
/// near a query is a run of a few strips. Queries that follow each other closely find it at once.
class Strips {
 public:
  /// Sorts other places and the `names` of them; the room is kept.
  void sort(const Places& places, const std::vector<std::int32_t>& names, const Context& context);

  Index count() const { return count_; }
  Index strip(float v) const;

  /// visit(name) for the strip's places that may be as near to (u, v) as the square root of
  /// `limit`, which visit may lower. False where the strip is too far.
  template <typename Visit>
  bool near(Index strip, float u, float v, const float& limit, const Visit& visit);

 private:
  static constexpr int lanes = 8;

  float gap(Index strip, float v) const {
    const float low = low_v_ + static_cast<float>(strip) * height_;
    return std::max({low - v, v - (low + height_), 0.0f});
  }
  // Moves the strip's cursor to a run that begins below `least`, the next of which does not.
  std::int32_t run_before(Index strip, float least);
  // The first run of `lanes` places with one near enough; `end` where there is none up to `most`.
  static std::int32_t first_near(const Places* sorted, std::int32_t at, std::int32_t end, float u,
                                 float v, float limit, float most);

  Index count_ = 0;
  float low_v_ = 0, height_ = 0, margin_ = 0;
  Places sorted_;  // and room for a run beyond the last, which no limit admits
  std::vector<std::int32_t> names_, begin_, cursor_;
  std::vector<std::int32_t> cells_, start_, by_cell_;  // while sorting
};

template <typename Visit>
bool Strips::near(Index strip, float u, float v, const float& limit, const Visit& visit) {
  const float beyond = std::max(gap(strip, v) - place_rounding, 0.0f);
  const float rest = limit - beyond * beyond;
  if (!(rest >= 0)) return false;
  const std::int32_t begin = begin_[strip], end = begin_[strip + 1];
  if (begin == end) return true;
  const float aside = std::max(sorted_.u[begin] - u, u - sorted_.u[end - 1]) - margin_;
  if (aside > 0 && aside * aside > rest) return true;
  const float reach = std::sqrt(rest) + margin_;
  std::int32_t at = run_before(strip, u - reach);
  while ((at = first_near(&sorted_, at, end, u, v, limit, u + reach)) < end)
    for (const std::int32_t next = std::min(at + lanes, end); at < next; ++at) {
      const float du = sorted_.u[at] - u, dv = sorted_.v[at] - v;
      if (du * du + dv * dv <= limit) visit(names_[at]);
    }
  return true;
}

}  // namespace symsurf
