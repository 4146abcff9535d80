#include "copies.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "parallel.h"
#include "radix_sort.h"

namespace symsurf {

namespace {

// The same for copies, all but surely another for others (the finaliser of MurmurHash3).
std::uint64_t hash(const Vector3& x) {
  std::uint64_t mixed = 0;
  for (const double coordinate : {x.x(), x.y(), x.z()}) {
    mixed = (mixed ^ std::bit_cast<std::uint64_t>(coordinate + 0.0)) * 0xff51afd7ed558ccdu;
    mixed = (mixed ^ mixed >> 33) * 0xc4ceb9fe1a85ec53u;
    mixed ^= mixed >> 33;
  }
  return mixed;
}

// Of points chosen by their hashes: those in one place are chosen or left out together.
bool many_copies(PointsView points, const Context& context) {
  constexpr double wanted = 1000, notable = 0.05;
  const double share = std::min(1.0, wanted / static_cast<double>(points.size()));
  const auto last = static_cast<std::uint64_t>(share * 0xffffffffu);
  std::vector<std::uint64_t> chosen;
  interruptible_for(context, points.size(), [&](Index i) {
    const std::uint64_t h = hash(points[i]);
    if (h >> 32 <= last) chosen.push_back(h);
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
  interruptible_for(context, points.size(), [&](Index i) { hashes[i] = hash(points[i]); });
  std::vector<std::int32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  radix_sort(hashes, order, context);

  std::vector<std::int32_t>& first_of = place_;  // at first the point, then its place's number
  std::size_t run = 0;
  interruptible_for(context, points.size(), [&](Index k) {
    if (hashes[k] != hashes[run]) run = k;
    const auto copy = std::find_if(order.begin() + run, order.begin() + k, [&](std::int32_t other) {
      return points[other] == points[order[k]];
    });
    first_of[order[k]] = *copy;
  });
  std::vector<std::int32_t> number(points.size());
  interruptible_for(context, points.size(), [&](Index i) {
    if (first_of[i] == i) {
      number[i] = static_cast<std::int32_t>(first_.size());
      first_.push_back(first_of[i]);
    }
    place_[i] = number[first_of[i]];
  });
}

Points Places::rows(PointsView points) const {
  return points.matrix()(first_, Eigen::indexing::all);
}

void Places::hand_on(Result& result) const {
  const auto points = static_cast<Index>(place_.size());
  std::vector<Index> rows_before(size() + 1, 0);
  for (Index row = 0; row < result.pairs.rows(); ++row) ++rows_before[result.pairs(row, 0) + 1];
  std::partial_sum(rows_before.begin(), rows_before.end(), rows_before.begin());
  std::vector<Index> rows(result.pairs.rows()), next = rows_before;
  for (Index row = 0; row < result.pairs.rows(); ++row) rows[next[result.pairs(row, 0)]++] = row;

  std::vector<Index> point, source;
  for (Index i = 0; i < points; ++i)
    for (Index k = rows_before[place_[i]]; k < rows_before[place_[i] + 1]; ++k) {
      point.push_back(i);
      source.push_back(rows[k]);
    }
  Pairs pairs(static_cast<Index>(source.size()), 2);
  for (Index row = 0; row < pairs.rows(); ++row)
    pairs.row(row) << point[row], first_[result.pairs(source[row], 1)];
  result.pairs = std::move(pairs);
  result.residuals = result.residuals(source).eval();
  result.surface_points = result.surface_points(source, Eigen::indexing::all).eval();
  const auto unpaired = result.statistics.find("unpaired_points");
  if (unpaired != result.statistics.end()) unpaired->second = points - result.pairs.rows();
}

}  // namespace symsurf
