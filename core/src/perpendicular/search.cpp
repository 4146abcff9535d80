#include "search.h"

#include <algorithm>
#include <utility>

#include "assembly.h"
#include "exploration.h"
#include "seeds.h"

namespace symsurf::perpendicular {

namespace {

struct Trials {
  std::vector<Growth> along, across;

  bool exact() const {
    const auto is_exact = [](const Growth& growth) {
      return growth.exact() && growth.closeness() > 0.6;
    };
    return std::any_of(along.begin(), along.end(), is_exact) ||
           std::any_of(across.begin(), across.end(), is_exact);
  }
};

// What the search starts from: seeds and the first steps from them.
Trials begin(const SearchCloud& cloud, std::uint64_t seed, const Context& context) {
  const Seeds seeds = find_seeds(cloud, seed, context);
  return {trials(cloud, seeds.along), trials(cloud, seeds.across)};
}

}  // namespace

Search search(const Cloud& cloud, Index sample_size, const Context& context) {
  Search search{SearchCloud(cloud, sample_size, context.stage(0, 0.2)), {}};
  Trials begun = begin(search.cloud, cloud.seed, context.stage(0.2, 0.4));
  if (search.cloud.noisy() && !begun.exact()) {
    search.cloud.smooth();
    begun = begin(search.cloud, cloud.seed, context.stage(0.4, 0.6));
  }
  explore(search.cloud, std::move(begun.along), search.sheets, context.stage(0.6, 0.7));
  explore(search.cloud, std::move(begun.across), search.sheets, context.stage(0.7, 0.8));
  search.sheets = assemble(search.cloud, std::move(search.sheets), context.stage(0.8, 1));
  return search;
}

}  // namespace symsurf::perpendicular
