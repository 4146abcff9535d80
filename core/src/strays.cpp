#include "strays.h"

#include <algorithm>
#include <cmath>

#include "gathered.h"
#include "parallel.h"

namespace symsurf {

namespace {

// What strays are beside is made of connected parts with at least one in twenty of the points each,
// holds most points, and spans less than half of the diagonal.
constexpr double least_part = 0.05, least_share = 0.85, most_extent = 0.5;

// A grid over a cloud, and which of its cells hold what strays are beside, or touch it.
class Body {
 public:
  Body(PointsView own, const PrincipalFrame& frame, const Context& context) : frame_(frame) {
    const Counts counts = counts_of(own, context);
    total_ = counts.sum();
    const std::vector<Index> cells = large_parts(counts);
    cells_.assign(volume, false);
    Vector3 low(side, side, side), high(0, 0, 0);
    for (const Index cell : cells) {
      const Vector3 at(cell / (side * side), cell / side % side, cell % side);
      low = low.cwiseMin(at);
      high = high.cwiseMax(at);
      for_each_touching(cell, [&](Index other) { cells_[other] = true; });
    }
    extent_ = (high - low + Vector3::Ones()).norm() / along;
    for (Index cell = 0; cell < volume; ++cell)
      if (cells_[cell]) held_ += counts[cell];
  }

  /// Of the points that the grid was laid over.
  Index held() const { return held_; }

  bool has_strays() const { return held_ < total_ && extent_ < most_extent; }

  bool holds(const Vector3& x) const { return cells_[cell_of(x)]; }

 private:
  // Off any lattice that the points may lie on: rounding must not decide between two cells.
  static constexpr double shift = 0.38197;
  // One more on each side, so that every cell of the cloud has its neighbours.
  static constexpr Index along = 16, side = along + 3, volume = side * side * side;
  using Counts = Eigen::Array<Index, volume, 1>;

  Index cell_of(const Vector3& x) const {
    const Vector3 at = (frame_.enter(x) - frame_.low) * along;
    Index cell = 0;
    for (const double a : at)
      cell = cell * side + 1 + static_cast<Index>(std::clamp<double>(a, 0, along) + shift);
    return cell;
  }

  Counts counts_of(PointsView own, const Context& context) const {
    constexpr Index grain = 1 << 16;
    const Counts none = Counts::Zero();
    return summed(context,
                  parallel_sum(context, own.size(), grain, none, [&](Index begin, Index end) {
                    Counts counts = Counts::Zero();
                    for (Index i = begin; i < end; ++i) ++counts[cell_of(own[i])];
                    return counts;
                  }));
  }

  template <typename Visit>
  static void for_each_touching(Index cell, const Visit& visit) {
    for (Index x = -1; x <= 1; ++x)
      for (Index y = -1; y <= 1; ++y)
        for (Index z = -1; z <= 1; ++z) visit(cell + (x * side + y) * side + z);
  }

  // The cells of all connected parts that are more than strays, and than would come together by
  // chance of as many strays as there may be, anywhere in the box.
  std::vector<Index> large_parts(const Counts& counts) const {
    const auto total = static_cast<double>(total_);
    const double box = ((frame_.high - frame_.low) * along).array().ceil().max(1).prod();
    const auto least = static_cast<Index>(2 + 4 * (1 - least_share) * total / box);
    std::vector<bool> seen(volume, false);
    std::vector<Index> cells;
    for (Index start = 0; start < volume; ++start) {
      const std::size_t first = cells.size();
      Index held = 0;
      const auto reach = [&](Index cell) {
        if (seen[cell] || counts[cell] < least) return;
        seen[cell] = true;
        held += counts[cell];
        cells.push_back(cell);
      };
      reach(start);
      for (std::size_t k = first; k < cells.size(); ++k) for_each_touching(cells[k], reach);
      if (static_cast<double>(held) < least_part * total) cells.resize(first);
    }
    return cells;
  }

  PrincipalFrame frame_;
  std::vector<bool> cells_;
  Index total_ = 0, held_ = 0;
  double extent_ = 0;
};

bool fills_area(const PrincipalFrame& frame) {
  constexpr double thinness = 1e-7;
  return frame.variance[1] > thinness * thinness * frame.variance[0];
}

}  // namespace

std::optional<Strays> Strays::where_any(const Cloud& cloud, const Method& method,
                                        const Context& context) {
  if (method.sees_strays) return std::nullopt;
  Strays strays(cloud, method.minimum_points, context);
  if (strays.all_.empty()) return std::nullopt;
  return strays;
}

Strays::Strays(const Cloud& cloud, Index needed, const Context& context) {
  const double share = least_share * static_cast<double>(cloud.total);
  const Index least = std::max(needed, static_cast<Index>(std::ceil(share)));
  Body body(cloud.points, cloud.frame, context);
  while (body.has_strays() && body.held() >= least) {
    const std::vector<Index> known = own_;
    own_.clear();
    auto next = known.begin();
    interruptible_for(context, cloud.points.size(), [&](Index i) {
      const bool is_known = next != known.end() && *next == i;
      if (is_known) ++next;
      if (is_known || !body.holds(cloud.points[i])) own_.push_back(i);
    });
    const Points left = rows(cloud.points);
    const PrincipalFrame frame = principal_frame(left, context);
    if (!fills_area(frame)) {
      own_ = known;
      break;
    }
    body = Body(left, frame, context);
  }
  all_ = own_;
  for (Index& i : all_) i += cloud.first;
  all_ = concatenated(context, all_);
}

Points Strays::rows(PointsView all) const {
  Points rows(all.size() - static_cast<Index>(own_.size()), 3);
  Index begin = 0, written = 0;
  const auto copy_up_to = [&](Index end) {
    rows.middleRows(written, end - begin) = all.matrix().middleRows(begin, end - begin);
    written += end - begin;
    begin = end + 1;
  };
  for (const Index stray : own_) copy_up_to(stray);
  copy_up_to(all.size());
  return rows;
}

void Strays::hand_on(Result& result) const {
  // As many strays are before a point as have no more others before them than it has.
  const auto numbered = [&](Index other) {
    const auto is_before = [&](const Index& stray) {
      return stray - (&stray - all_.data()) <= other;
    };
    return other + (std::partition_point(all_.begin(), all_.end(), is_before) - all_.begin());
  };
  result.pairs = result.pairs.unaryExpr(numbered);
  result.statistics["stray_points"] = static_cast<Index>(all_.size());
  const auto unpaired = result.statistics.find("unpaired_points");
  if (unpaired != result.statistics.end())
    std::get<Index>(unpaired->second) += static_cast<Index>(all_.size());
}

}  // namespace symsurf
