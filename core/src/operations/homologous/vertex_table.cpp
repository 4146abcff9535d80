#include "operations/homologous/vertex_table.h"

#include <algorithm>
#include <map>

#include "base/parallel.h"
#include "spatial/point_tree.h"

namespace symsurf {

namespace {

constexpr Index table_grain = 1024;
constexpr int most_rounds = 50;  // a wrong patch shrinks by a ring of vertices a round
// After so many rounds one in so many vertices may still change: on resampled sides they go on.
constexpr int few_rounds = 5, most_changing = 10;
constexpr double most_turned = 0.5;  // of the edges at a vertex: quadrangles divided at random
constexpr double least_share = 0.9;  // resampled sides reach a half

}  // namespace

std::vector<Index> vertex_table(PointsView points, PointsView images, const SurfaceGraph& graph,
                                const Points& displacements, const Context& context) {
  const PointTree tree(images, context.stage(0, 0.1));
  std::vector<Index> table(points.size());
  const auto target = [&](Index i) -> Vector3 {
    return points[i] + displacements.row(i).transpose();
  };
  parallel_for(context.stage(0.1, 0.3), points.size(), table_grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) table[i] = tree.nearest(target(i)).index;
  });
  // How many edges at a vertex go to edges at its partner, were this the partner.
  const auto kept_edges = [&](Index i, Index partner) {
    const auto around = graph.neighbours(i);
    return std::count_if(around.begin(), around.end(), [&](std::int32_t j) {
      return table[j] >= 0 && graph.are_neighbours(table[j], partner);
    });
  };
  // Each vertex takes the partner that keeps most of its edges, of several the nearest; if asked
  // to, none that has another.
  const auto best_partner = [&](Index i, bool free_only) {
    Index best = table[i], most = best < 0 ? 0 : kept_edges(i, best);
    double nearest = 0;
    std::map<Index, Index> votes;
    for (const std::int32_t j : graph.neighbours(i))
      if (table[j] >= 0)
        for (const std::int32_t candidate : graph.neighbours(table[j])) ++votes[candidate];
    for (const auto& [candidate, count] : votes) {
      if (count < most || (count == most && best == table[i])) continue;
      if (free_only && table[candidate] >= 0 && table[candidate] != i) continue;
      const double distance = (images[candidate] - target(i)).squaredNorm();
      if (count == most && distance >= nearest) continue;
      best = candidate;
      most = count;
      nearest = distance;
    }
    return best;
  };
  const auto relax = [&](bool free_only, const Context& part) {
    for (int round = 0; round < most_rounds; ++round) {
      std::vector<Index> next(table.size());
      parallel_for(part, points.size(), table_grain, [&](Index begin, Index end) {
        for (Index i = begin; i < end; ++i) next[i] = best_partner(i, free_only);
      });
      Index changed = 0;
      for (std::size_t i = 0; i < table.size(); ++i) changed += next[i] != table[i];
      table.swap(next);
      if (changed == 0 || (round >= few_rounds && changed > points.size() / most_changing)) break;
    }
  };
  // Forgets what is no pair, or keeps too few edges. Gives how many partners are left.
  const auto keep_sound = [&] {
    std::vector<Index> sound(table.size(), -1);
    for (Index i = 0; i < points.size(); ++i) {
      const auto edges = static_cast<double>(graph.neighbours(i).size());
      if (table[i] >= 0 && edges > 0 && table[table[i]] == i &&
          static_cast<double>(kept_edges(i, table[i])) >= (1 - most_turned) * edges)
        sound[i] = table[i];
    }
    table.swap(sound);
    return points.size() - std::count(table.begin(), table.end(), Index{-1});
  };
  Index joined = 0;
  for (Index i = 0; i < points.size(); ++i) joined += !graph.neighbours(i).empty();
  relax(false, context.stage(0.3, 0.8));
  if (static_cast<double>(keep_sound()) < least_share * static_cast<double>(joined) || joined == 0)
    return {};
  // From the sound part into what patches beside it had wrong.
  relax(true, context.stage(0.8, 1));
  keep_sound();
  return table;
}

}  // namespace symsurf
