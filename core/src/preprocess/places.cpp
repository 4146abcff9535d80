#include "preprocess/places.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"
#include "base/radix_sort.h"
#include "score/matching.h"
#include "spatial/point_hash.h"

namespace symsurf {

namespace {

// Of points chosen by their hashes: those in one place are chosen or left out together.
bool many_copies(PointsView points, const Context& context) {
  constexpr double wanted = 1000, notable = 0.05;
  const double share = std::min(1.0, wanted / static_cast<double>(points.size()));
  std::vector<std::uint64_t> chosen;
  interruptible_for(context, points.size(), [&](Index i) {
    const std::uint64_t hash = hash_of(points[i]);
    if (is_chosen(hash, share)) chosen.push_back(hash);
  });
  std::sort(chosen.begin(), chosen.end());
  const auto distinct = std::unique(chosen.begin(), chosen.end()) - chosen.begin();
  const auto all = static_cast<double>(chosen.size());
  return static_cast<double>(distinct) < (1 - notable) * all;
}

}  // namespace

std::optional<Places> Places::where_copied(PointsView points, const Context& context) {
  if (!many_copies(points, context)) return std::nullopt;
  return Places(points, context);
}

Places::Places(PointsView points, const Context& context) : place_(points.size()) {
  std::vector<std::uint64_t> hashes(points.size());
  interruptible_for(context, points.size(), [&](Index i) { hashes[i] = hash_of(points[i]); });
  std::vector<std::int32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  radix_sort(hashes, order, context);

  // The first point of each point's place, until places are numbered.
  std::size_t run = 0;
  interruptible_for(context, points.size(), [&](Index k) {
    if (hashes[k] != hashes[run]) run = k;
    const auto copy = std::find_if(order.begin() + run, order.begin() + k, [&](std::int32_t other) {
      return points[other] == points[order[k]];
    });
    place_[order[k]] = *copy;
  });
  interruptible_for(context, points.size(), [&](Index i) {
    const std::int32_t first = place_[i];
    const bool is_first = first == i;
    place_[i] = is_first ? static_cast<std::int32_t>(first_.size()) : place_[first];
    if (is_first) first_.push_back(first);
  });
}

Points Places::rows(PointsView points) const {
  return points.matrix()(first_, Eigen::indexing::all);
}

void Places::hand_on(Result& result) const {
  std::vector<Index> row_of(size(), -1);
  for (Index row = 0; row < result.pairs.rows(); ++row) row_of[result.pairs(row, 0)] = row;
  const auto points = static_cast<Index>(place_.size());
  std::vector<Index> paired, rows;
  for (Index i = 0; i < points; ++i) {
    const Index row = row_of[place_[i]];
    if (row < 0) continue;
    paired.push_back(i);
    rows.push_back(row);
  }
  keep_pairs(result, rows);
  for (Index row = 0; row < result.pairs.rows(); ++row)
    result.pairs.row(row) << paired[row], first_[result.pairs(row, 1)];
  count_unpaired(result, points);
}

}  // namespace symsurf
