#include "projection.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "../parallel.h"
#include "../radix_sort.h"

namespace symsurf {

namespace {

constexpr int key_bits = 22;
constexpr double key_cells = (1 << key_bits) - 1;

/// Axes across the direction and the strips along the first of them.
struct Strips {
  Vector3 origin, e1, e2;
  double low_u = 0, low_v = 0, height = 1, width = 1, extent = 0;
  Index count = 1;

  Strips(PointsView points, const std::vector<std::int32_t>& targets, const Vector3& direction)
      : origin(points[targets.front()]), e1(direction.unitOrthogonal()), e2(direction.cross(e1)) {
    low_u = low_v = std::numeric_limits<double>::infinity();
    double high_u = -low_u, high_v = -low_v;
    for (const std::int32_t i : targets) {
      const Vector3 w = points[i] - origin;
      const double u = e1.dot(w), v = e2.dot(w);
      low_u = std::min(low_u, u);
      high_u = std::max(high_u, u);
      low_v = std::min(low_v, v);
      high_v = std::max(high_v, v);
    }
    extent = std::max(high_u - low_u, high_v - low_v);
    const double rows = std::sqrt(static_cast<double>(targets.size()) / 2);
    count = std::max<Index>(1, static_cast<Index>(rows));
    height = (high_v - low_v) / static_cast<double>(count);
    width = (high_u - low_u) / key_cells;
  }

  Index strip(double v) const {
    if (!(height > 0)) return 0;
    const double at = (v - low_v) / height;
    return static_cast<Index>(std::clamp(at, 0.0, static_cast<double>(count - 1)));
  }
  // Monotonous in u, so that a run sorted by key is sorted by u to within a cell.
  std::uint64_t along(double u) const {
    if (!(width > 0)) return 0;
    return static_cast<std::uint64_t>(std::clamp((u - low_u) / width, 0.0, key_cells));
  }
};

struct Place {
  double u, v;
  std::int32_t index;
};

// In the order of strips, and along each; ties as given.
std::vector<std::int32_t> sort(PointsView points, const std::vector<std::int32_t>& chosen,
                               const Strips& strips, std::vector<Place>& places,
                               const Context& context) {
  std::vector<Place> unsorted(chosen.size());
  std::vector<std::uint64_t> keys(chosen.size());
  std::vector<std::int32_t> order(chosen.size());
  const auto count = static_cast<Index>(chosen.size());
  interruptible_for(context, count, [&](Index k) {
    const Vector3 w = points[chosen[k]] - strips.origin;
    const Place place{strips.e1.dot(w), strips.e2.dot(w), chosen[k]};
    unsorted[k] = place;
    keys[k] = static_cast<std::uint64_t>(strips.strip(place.v)) << key_bits | strips.along(place.u);
    order[k] = static_cast<std::int32_t>(k);
  });
  radix_sort(keys, order, context);
  places.resize(chosen.size());
  interruptible_for(context, count, [&](Index k) { places[k] = unsorted[order[k]]; });
  return order;
}

/// One query's search, strip by strip outwards from its own.
class Sweep {
 public:
  Sweep(PointsView points, const Vector3& direction, const Strips& strips,
        const std::vector<Place>& targets)
      : points_(points), direction_(direction), strips_(strips), targets_(targets) {
    begin_.assign(strips.count + 1, static_cast<std::int32_t>(targets.size()));
    for (Index k = static_cast<Index>(targets.size()) - 1; k >= 0; --k)
      begin_[strips.strip(targets[k].v)] = static_cast<std::int32_t>(k);
    for (Index s = strips.count - 1; s >= 0; --s) begin_[s] = std::min(begin_[s], begin_[s + 1]);
    cursor_.assign(begin_.begin(), begin_.end() - 1);
  }

  void nearest(const Place& query) {
    query_ = query;
    x_ = points_[query.index];
    best_ = std::numeric_limits<std::int32_t>::max();
    squared_ = limit_ = std::numeric_limits<double>::infinity();
    // The last answer is a good one: consecutive queries follow each other along the strips.
    consider(last_);
    const Index own = strips_.strip(query.v);
    scan(own, 0);
    for (Index s = own + 1; s < strips_.count; ++s)
      if (!scan(s, std::max(0.0, low_edge(s) - query.v))) break;
    for (Index s = own - 1; s >= 0; --s)
      if (!scan(s, std::max(0.0, query.v - low_edge(s + 1)))) break;
  }

  std::int32_t index() const { return best_; }
  double squared() const { return squared_; }

 private:
  double low_edge(Index s) const { return strips_.low_v + static_cast<double>(s) * strips_.height; }

  // False where the strip, `gap` away, is too far to hold anything nearer.
  bool scan(Index s, double gap) {
    gap = std::max(0.0, gap - rounding * strips_.extent);
    if (gap * gap > limit_) return false;
    const std::int32_t begin = begin_[s], end = begin_[s + 1];
    std::int32_t at = cursor_[s];
    while (at < end && targets_[at].u < query_.u) ++at;
    while (at > begin && targets_[at - 1].u >= query_.u) --at;
    cursor_[s] = at;
    // Along a strip the order is that of the keys: to within a cell.
    const auto too_far = [&](double du) {
      du = std::max(0.0, du - strips_.width);
      return du * du + gap * gap > limit_;
    };
    for (std::int32_t k = at; k < end && !too_far(targets_[k].u - query_.u); ++k) consider(k);
    for (std::int32_t k = at - 1; k >= begin && !too_far(query_.u - targets_[k].u); --k)
      consider(k);
    return true;
  }

  void consider(std::int32_t k) {
    const double du = targets_[k].u - query_.u, dv = targets_[k].v - query_.v;
    if (du * du + dv * dv > limit_) return;
    // The decision is made on the distance from the line itself, not on rounded projections.
    const std::int32_t index = targets_[k].index;
    const Vector3 w = points_[index] - x_;
    const Vector3& v = direction_;
    const double along = w.x() * v.x() + w.y() * v.y() + w.z() * v.z();
    const double x = w.x() - along * v.x(), y = w.y() - along * v.y(), z = w.z() - along * v.z();
    const double squared = x * x + y * y + z * z;
    if (squared > squared_ || (squared == squared_ && index >= best_)) return;
    best_ = index;
    last_ = k;
    squared_ = squared;
    const double distance = std::sqrt(squared) + rounding * strips_.extent;
    limit_ = distance * distance;
  }

  static constexpr double rounding = 1e-13;

  PointsView points_;
  const Vector3& direction_;
  const Strips& strips_;
  const std::vector<Place>& targets_;
  std::vector<std::int32_t> begin_, cursor_;  // of each strip

  Place query_{};
  Vector3 x_ = Vector3::Zero();
  std::int32_t best_ = 0, last_ = 0;  // as an index, as a place
  double squared_ = 0, limit_ = 0;
};

}  // namespace

LinePartners nearest_to_lines(PointsView points, const std::vector<std::int32_t>& queries,
                              const std::vector<std::int32_t>& targets, const Vector3& direction,
                              const Context& context) {
  const Strips strips(points, targets, direction);
  std::vector<Place> target_places, query_places;
  sort(points, targets, strips, target_places, context);
  const std::vector<std::int32_t> order = sort(points, queries, strips, query_places, context);

  LinePartners found;
  found.target.resize(queries.size());
  found.squared.resize(queries.size());
  Sweep sweep(points, direction, strips, target_places);
  interruptible_for(context, static_cast<Index>(queries.size()), [&](Index k) {
    sweep.nearest(query_places[k]);
    found.target[order[k]] = sweep.index();
    found.squared[order[k]] = sweep.squared();
  });
  return found;
}

}  // namespace symsurf
