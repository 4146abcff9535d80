#include "spatial/occupied_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "random_cloud.h"

namespace symsurf {
namespace {

TEST(OccupiedCells, AreNumberedInTheirOrder) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const Index cells : {1, 63, 64, 65, 1000}) {
      RandomCloud random(seed);
      const auto draw = [&] {
        return std::min(cells - 1, static_cast<Index>(random.uniform(0, 1) * cells));
      };
      OccupiedCells occupied(cells), others(cells);
      std::set<Index> known{0, cells - 1};
      for (Index k = 0; k < cells / 3; ++k) {
        const Index here = draw(), there = draw();
        occupied.add(here);
        others.add(there);
        known.insert({here, there});
      }
      occupied.add(0);
      occupied.add(cells - 1);
      occupied.add(others.words());
      occupied.number_them();

      Index before = 0;
      for (Index cell = 0; cell < cells; ++cell) {
        EXPECT_EQ(occupied.before(cell), before) << seed << ' ' << cells;
        EXPECT_EQ(occupied.number(cell), known.contains(cell) ? before : -1) << seed << ' ' << cell;
        before += known.contains(cell);
      }
      EXPECT_EQ(occupied.before(cells), before) << seed << ' ' << cells;
      EXPECT_EQ(occupied.count(), before) << seed << ' ' << cells;
    }
}

}  // namespace
}  // namespace symsurf
