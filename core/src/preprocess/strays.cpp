#include "preprocess/strays.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/gathered.h"
#include "base/parallel.h"
#include "spatial/cells.h"

namespace symsurf {

namespace {

// What strays are beside is made of connected parts with at least one in twenty of the points each,
// holds most points, and spans less than half of the diagonal.
constexpr double least_part = 0.05, least_share = 0.85, most_extent = 0.5;

// The cells over a cloud that hold what strays are beside, or touch it.
class Body {
 public:
  Body(PointsView own, const PrincipalFrame& frame, const Context& context)
      : frame_(frame), cells_(frame.low, frame.high, edge) {
    Counts counts = counts_of(own, context);
    count_once_what_is_one_place(own, counts, context);
    total_ = counts.sum();
    holding_.assign(counts.size(), false);
    Cells::Cell low = cells_.cell_of(frame.high), high = cells_.cell_of(frame.low);
    for (const Index k : large_parts(counts)) {
      const Cells::Cell cell = cells_.numbered(k);
      low = low.cwiseMin(cell);
      high = high.cwiseMax(cell);
      for_each_touching(k, [&](Index other) { holding_[other] = true; });
    }
    extent_ = edge * (high - low + Cells::Cell::Ones()).cast<double>().norm();
    for (std::size_t k = 0; k < holding_.size(); ++k)
      if (holding_[k]) held_ += counts[k];
  }

  /// The points that the cells were laid over; many in one place apart from the others are one.
  Index total() const { return total_; }

  /// Of these, what the cells hold.
  Index held() const { return held_; }

  bool has_strays() const { return held_ < total_ && extent_ < most_extent; }

  bool holds(const Vector3& x) const { return holding_[number_at(x)]; }

 private:
  using Counts = Eigen::ArrayX<Index>;
  static constexpr double edge = 1. / 16;  // diagonals

  Index number_at(const Vector3& x) const { return cells_.number(cells_.cell_of(frame_.enter(x))); }

  Counts counts_of(PointsView own, const Context& context) const {
    constexpr Index grain = 1 << 16;
    const Counts none = Counts::Zero(cells_.count());
    return summed(context,
                  parallel_sum(context, own.size(), grain, none, [&](Index begin, Index end) {
                    Counts counts = none;
                    for (Index i = begin; i < end; ++i) ++counts[number_at(own[i])];
                    return counts;
                  }));
  }

  // Pixels without depth, written as the origin, are often more than any part of the body.
  void count_once_what_is_one_place(PointsView own, Counts& counts, const Context& context) const {
    const double many = least_part * static_cast<double>(counts.sum());
    for (Index k = 0; k < counts.size(); ++k) {
      if (static_cast<double>(counts[k]) < many || counts[k] < 2) continue;
      Index around = 0;
      for_each_touching(k, [&](Index other) { around += counts[other]; });
      if (around == counts[k] && is_one_place(own, k, context)) counts[k] = 1;
    }
  }

  bool is_one_place(PointsView own, Index number, const Context& context) const {
    std::vector<Vector3> places;
    for (Index i = 0; i < own.size() && places.size() < 2; ++i)
      if (number_at(own[i]) == number && (places.empty() || own[i] != places.front()))
        places.push_back(own[i]);
    places = concatenated(context, places);
    return std::all_of(places.begin(), places.end(),
                       [&](const Vector3& x) { return x == places.front(); });
  }

  template <typename Visit>
  void for_each_touching(Index number, const Visit& visit) const {
    cells_.for_each_row_touching(cells_.numbered(number), [&](Index begin, Index end) {
      for (Index k = begin; k < end; ++k) visit(k);
    });
  }

  // The cells of all connected parts that are more than strays, and than would come together by
  // chance of as many strays as there may be, anywhere in the box.
  std::vector<Index> large_parts(const Counts& counts) const {
    const auto total = static_cast<double>(total_);
    const double box = ((frame_.high - frame_.low) / edge).array().ceil().max(1).prod();
    const auto least = static_cast<Index>(2 + 4 * (1 - least_share) * total / box);
    std::vector<bool> seen(counts.size(), false);
    std::vector<Index> cells;
    for (Index start = 0; start < counts.size(); ++start) {
      const std::size_t first = cells.size();
      Index held = 0;
      const auto reach = [&](Index k) {
        if (seen[k] || counts[k] < least) return;
        seen[k] = true;
        held += counts[k];
        cells.push_back(k);
      };
      reach(start);
      for (std::size_t k = first; k < cells.size(); ++k) for_each_touching(cells[k], reach);
      if (static_cast<double>(held) < least_part * total) cells.resize(first);
    }
    return cells;
  }

  PrincipalFrame frame_;
  Cells cells_;
  std::vector<bool> holding_;
  Index total_ = 0, held_ = 0;
  double extent_ = 0;
};

bool fills_area(const PrincipalFrame& frame) {
  constexpr double thinness = 1e-7;
  return frame.variance[1] > thinness * thinness * frame.variance[0];
}

}  // namespace

std::optional<Strays> Strays::where_any(const Cloud& cloud, Index needed, const Context& context) {
  Strays strays(cloud, needed, context);
  if (strays.removal_.count() == 0) return std::nullopt;
  return strays;
}

std::optional<Strays> Strays::where_any(const Cloud& cloud, const Method& method,
                                        const Context& context) {
  if (method.sees_strays) return std::nullopt;
  return where_any(cloud, method.minimum_points, context);
}

Strays::Strays(const Cloud& cloud, Index needed, const Context& context) {
  Body body(cloud.points, cloud.frame, context);
  const double share = least_share * static_cast<double>(body.total());
  const Index least = std::max(needed, static_cast<Index>(std::ceil(share)));
  std::vector<Index> own;
  while (body.has_strays() && body.held() >= least) {
    const std::vector<Index> known = own;
    own.clear();
    auto next = known.begin();
    interruptible_for(context, cloud.points.size(), [&](Index i) {
      const bool is_known = next != known.end() && *next == i;
      if (is_known) ++next;
      if (is_known || !body.holds(cloud.points[i])) own.push_back(i);
    });
    const Points left = RowRemoval(own, 0, Context()).apply(cloud.points);
    const PrincipalFrame frame = principal_frame(left, context);
    if (!fills_area(frame)) {
      own = known;
      break;
    }
    body = Body(left, frame, context);
  }
  removal_ = RowRemoval(std::move(own), cloud.first, context);
}

void Strays::hand_on(Result& result) const {
  removal_.map_back(result);
  result.statistics["stray_points"] = removal_.count();
}

}  // namespace symsurf
