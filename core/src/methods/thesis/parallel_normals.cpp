#include "methods/thesis/parallel_normals.h"

#include <algorithm>
#include <limits>

#include "base/parallel.h"
#include "methods/thesis/most_parallel.h"
#include "spatial/point_tree.h"

namespace symsurf {

ParallelNormals::ParallelNormals(PointsView points, PointsView normals, bool as_lines,
                                 const Context& context)
    : points_(points),
      normals_(normals),
      context_(context),
      as_lines_(as_lines),
      position_(points.size()),
      lists_(points.size()) {
  list_most_parallel();
  list_ties();
}

void ParallelNormals::list_most_parallel() {
  // Places on the unit sphere; a line has two.
  const auto count = static_cast<std::int32_t>(normals_.size());
  Points places(as_lines_ ? 2 * count : count, 3);
  interruptible_for(context_, count, [&](Index i) {
    places.row(i) = normals_[i].transpose();
    if (as_lines_) places.row(count + i) = -normals_[i].transpose();
  });
  const PointTree tree(places, context_);
  interruptible_for(context_, tree.size(), [&](Index p) {
    const std::int32_t i = tree.order()[p];
    if (i >= count) return;
    position_[i] = static_cast<std::int32_t>(order_.size());
    order_.push_back(i);
  });

  sorted_points_.resize(count, 3);
  sorted_normals_.resize(count, 3);
  interruptible_for(context_, count, [&](Index p) {
    sorted_points_.row(p) = points_[order_[p]].transpose();
    sorted_normals_.row(p) = normals_[order_[p]].transpose();
  });

  // Itself, the listed and one more, which tells whether the last is tied.
  const auto neighbours = std::min<Index>(std::tuple_size_v<List> + 2, tree.size());
  constexpr Index grain = 2048;
  parallel_for(context_, count, grain, [&](Index begin, Index end) {
    std::vector<Neighbour> nearest;
    for (Index p = begin; p < end; ++p) {
      tree.nearest(normals_[order_[p]], neighbours, nearest);
      // Farther apart than this, cosines tell angles apart as well.
      constexpr double rounding = 1e-14;
      auto next = lists_[p].begin();
      for (Index k = 0; k + 1 < neighbours && next != lists_[p].end(); ++k) {
        const std::int32_t position = position_[nearest[k].index % count];
        if (position == p) continue;
        const double gap = nearest[k + 1].squared_distance - nearest[k].squared_distance;
        *next++ = {position, gap <= rounding};
      }
    }
  });
}

void ParallelNormals::list_ties() {
  std::vector<std::int32_t> tied;
  interruptible_for(context_, static_cast<Index>(lists_.size()), [&](Index p) {
    if (std::all_of(lists_[p].begin(), lists_[p].end(),
                    [](const Listed& one) { return one.is_tied; }))
      tied.push_back(static_cast<std::int32_t>(p));
  });
  if (tied.empty()) return;
  MostParallel all(normals_, as_lines_);
  interruptible_for(context_, static_cast<Index>(order_.size()),
                    [&](Index p) { all.add(order_[p]); });
  all.build(context_);
  constexpr Index grain = 256;
  parallel_for(context_, static_cast<Index>(tied.size()), grain, [&](Index begin, Index end) {
    std::vector<std::int32_t> indices;
    for (Index k = begin; k < end; ++k) {
      List& list = lists_[tied[k]];
      all.list(order_[tied[k]], list.size(), indices);
      list = {};
      std::transform(indices.begin(), indices.end(), list.begin(), [&](std::int32_t i) {
        return Listed{position_[i], false};
      });
    }
  });
}

std::int32_t ParallelNormals::listed(Index position, const Partners& partners) const {
  const List& list = lists_[position];
  const auto ends = [&](auto at) { return at == list.end() || at->position < 0; };
  auto at = list.begin();
  while (!ends(at) && partners[at->position] >= 0) ++at;
  if (ends(at)) return -1;
  std::int32_t best = at->position;
  if (!at->is_tied) return best;

  const PointsView normals(sorted_normals_);
  const auto cosine = [&](std::int32_t other) {
    return cosine_between(normals[position], normals[other], as_lines_);
  };
  double most = cosine(best);
  while (at->is_tied) {
    if (ends(++at)) return -1;
    if (partners[at->position] >= 0) continue;
    const double c = cosine(at->position);
    if (c < most || (c == most && order_[at->position] > order_[best])) continue;
    most = c;
    best = at->position;
  }
  return best;
}

double ParallelNormals::searched(const std::vector<std::int32_t>& positions,
                                 const Partners& partners) const {
  MostParallel most_parallel(normals_, as_lines_);
  std::vector<std::int32_t> guesses;
  std::int32_t added = -1;
  interruptible_for(context_, static_cast<Index>(order_.size()), [&](Index p) {
    if (guesses.size() < positions.size() && positions[guesses.size()] == p)
      guesses.push_back(most_parallel.guess());
    if (partners[p] >= 0) return;
    // Of equal ones, which follow each other, the first is the answer: flat faces cost no more.
    const std::int32_t i = order_[p];
    if (added >= 0 && added < i && normals_[added] == normals_[i]) return;
    most_parallel.add(added = i);
  });
  most_parallel.build(context_);

  double sum = 0;
  constexpr Index block = MostParallel::block, stretch = 1 << 11;
  const auto count = static_cast<Index>(positions.size());
  interruptible_for(
      context_, (count + block - 1) / block,
      [&](Index b) {
        const Index first = b * block;
        std::array<std::int32_t, block> indices;
        for (Index k = 0; k < block; ++k)
          indices[k] = order_[positions[std::min(first + k, count - 1)]];
        most_parallel.find(indices, guesses[first]);
        for (Index k = first; k < std::min(first + block, count); ++k)
          sum +=
              (points_[partners[positions[k]]] - points_[most_parallel[k - first]]).squaredNorm();
      },
      stretch);
  return sum;
}

double ParallelNormals::projection_error(const Separation& separation) const {
  const auto count = static_cast<Index>(separation.upper.size());
  Partners partners(points_.size(), -1);
  interruptible_for(context_, count, [&](Index k) {
    partners[position_[separation.upper[k]]] = separation.partner[k];
  });

  double sum = 0;
  std::vector<std::int32_t> rest;
  const PointsView sorted(sorted_points_);
  interruptible_for(context_, points_.size(), [&](Index p) {
    if (partners[p] < 0) return;
    const std::int32_t q = listed(p, partners);
    if (q < 0)
      rest.push_back(static_cast<std::int32_t>(p));
    else
      sum += (points_[partners[p]] - sorted[q]).squaredNorm();
  });
  if (!rest.empty()) sum += searched(rest, partners);
  return sum / static_cast<double>(count);
}

}  // namespace symsurf
