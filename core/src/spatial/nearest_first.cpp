#include "spatial/nearest_first.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "base/vectorised.h"

namespace symsurf {

namespace {

// So few are put in order by counting for each how many come before it, which foretells nothing and
// so never foretells wrongly; more are sorted.
constexpr std::size_t few = 48;

struct Candidates {
  std::array<double, few> squared, index;
};

// `count` is a multiple of the vector's width.
SYMSURF_VECTORISED void rank(const Candidates* candidates, std::size_t count, std::int64_t* ranks) {
  typedef std::int64_t Counts __attribute__((vector_size(sizeof(Doubles)), aligned(8), may_alias));
  const double *squared = candidates->squared.data(), *index = candidates->index.data();
  for (std::size_t i = 0; i < count; i += doubles_wide) {
    const Doubles d = *reinterpret_cast<const Doubles*>(squared + i),
                  named = *reinterpret_cast<const Doubles*>(index + i);
    Counts before{};
    for (std::size_t j = 0; j < count; ++j)
      before -= (squared[j] < d) | ((squared[j] == d) & (index[j] < named));
    *reinterpret_cast<Counts*>(ranks + i) = before;
  }
}

}  // namespace

void keep_nearest(std::vector<Neighbour>& found, std::size_t count, std::size_t k) {
  if (count > few) {
    const auto begin = found.begin(), kth = begin + static_cast<std::ptrdiff_t>(k - 1);
    std::nth_element(begin, kth, begin + static_cast<std::ptrdiff_t>(count));
    std::sort(begin, kth);
    found.resize(k);
    return;
  }
  Candidates candidates;
  for (std::size_t i = 0; i < count; ++i) {
    candidates.squared[i] = found[i].squared_distance;
    candidates.index[i] = static_cast<double>(found[i].index);
  }
  std::size_t padded = count;
  for (; padded % doubles_wide != 0; ++padded)
    candidates.squared[padded] = candidates.index[padded] = std::numeric_limits<double>::infinity();
  std::array<std::int64_t, few> ranks;
  rank(&candidates, padded, ranks.data());
  std::array<Neighbour, few> ranked;
  for (std::size_t i = 0; i < count; ++i)
    ranked[ranks[i]] = {static_cast<Index>(candidates.index[i]), candidates.squared[i]};
  found.assign(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(k));
}

}  // namespace symsurf
