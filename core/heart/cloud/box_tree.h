#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

namespace symsurf {

/// A limit that lets squared distances of up to this one pass: trees compare with "<", and sum
/// bounds with rounding.
inline double at_most(double squared) { return squared * (1 + 1e-12) + 1e-300; }

/// A bounding volume hierarchy of points along a Z-order curve, split at the highest bit in which
/// their keys differ (Lauterbach et al. 2009). Searches offer candidates to the caller, who decides
/// about them and how far to look on; PointTree is what most callers want. Eight queries next to
/// each other are fastest together.
class BoxTree {
 public:
  static constexpr int lanes = 8;

  /// At least one point, all finite, and their keys, which ascend. Checks the context for
  /// cancellation while it builds.
  BoxTree(std::vector<Vector3> points, const std::vector<std::uint64_t>& keys,
          const Context& context);

  const Vector3& point(std::int32_t i) const { return points_[i]; }

  /// Calls limit = offer(i, squared distance) for each point i whose squared distance from the
  /// query is less than `limit`, near ones first, as long as there are any. To see all points at a
  /// limit, ties among them, let limits be at_most() it.
  template <typename Offer>
  void search(const Vector3& query, double limit, const Offer& offer) const {
    const Vector3 q = unit_ * query;
    descend([&](const Node& node) { return squared_distance(node, q) / (unit_ * unit_); }, limit,
            [&](std::uint32_t i, double left) {
              const double squared = (points_[i] - query).squaredNorm();
              return squared < left ? offer(i, squared) : left;
            });
  }

  /// The same with a distance of the caller's: bound(low, high) is no more than its square anywhere
  /// in the box of these corners. Calls offer(i) of what lies in a leaf, unmeasured.
  template <typename Bound, typename Offer>
  void search_boxes(const Bound& bound, double limit, const Offer& offer) const {
    descend(
        [&](const Node& node) {
          return bound(Vector3(vector_of(node.low) / unit_), Vector3(vector_of(node.high) / unit_));
        },
        limit, [&](std::uint32_t i, double) { return offer(i); });
  }

  /// Of each of up to `lanes` queries the nearest point no farther than the root of `limit`; -1:
  /// none, -2: not to be told in single precision.
  std::array<std::int32_t, lanes> nearest(const Vector3* queries, int count, double limit) const;

 private:
  // In units, rounded outwards.
  struct Node {
    float low[3], high[3];
    std::uint32_t begin, end;  // of a leaf's points; else `begin` is none, `end` the second child
  };
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  struct Packet;

  static Vector3 vector_of(const float* x) { return {x[0], x[1], x[2]}; }
  static double squared_distance(const Node& node, const Vector3& q) {
    double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double off = std::max({node.low[axis] - q[axis], q[axis] - node.high[axis], 0.0});
      squared += off * off;
    }
    return squared;
  }

  std::uint32_t add(std::uint32_t begin, std::uint32_t end, const std::vector<std::uint64_t>& keys,
                    const Context& context);

  // The nearer child first; limit = offer(i, limit) of the points of leaves.
  template <typename Distance, typename Offer>
  void descend(const Distance& distance, double limit, const Offer& offer) const {
    std::array<std::pair<double, std::uint32_t>, deepest> waiting;
    std::size_t count = 0;
    double here = distance(nodes_.front());
    for (std::uint32_t at = 0;;) {
      const Node& node = nodes_[at];
      if (here <= limit && node.begin == none) {
        std::pair near{distance(nodes_[at + 1]), at + 1}, far{distance(nodes_[node.end]), node.end};
        if (far.first < near.first) std::swap(near, far);
        waiting[count++] = far;
        std::tie(here, at) = near;
        continue;
      }
      if (here <= limit)
        for (std::uint32_t i = node.begin; i < node.end; ++i) limit = offer(i, limit);
      if (count == 0) return;
      std::tie(here, at) = waiting[--count];
    }
  }
  static constexpr std::size_t deepest = 128;  // 63 bits of a key, and halves of equal ones

  std::vector<Vector3> points_;
  double unit_ = 1;          // a power of two: single precision ends at 1e38
  std::vector<float> flat_;  // coordinates in units, three a point
  std::vector<Node> nodes_;
};

}  // namespace symsurf
