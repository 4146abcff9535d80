#pragma once

#include <symsurf/context.h>
#include <symsurf/points_view.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace symsurf {

/// A point of the cloud and its squared distance from a query; index -1: none.
struct Neighbour {
  Index index = -1;
  double squared_distance = std::numeric_limits<double>::infinity();

  /// Nearer first, ties by index.
  bool operator<(const Neighbour& other) const {
    return squared_distance != other.squared_distance ? squared_distance < other.squared_distance
                                                      : index < other.index;
  }
};

/// Exact nearest neighbours of many coherent queries in one big cloud.
///
/// A packed R-tree: the points sorted along the Z-order curve, boxes over runs of 8, boxes over
/// runs of 8 boxes and so on (Kamel and Faloutsos 1993, bulk loading). Built by a radix sort, in
/// about a third of a KD-tree's time, 31 bytes a point; queries in the tree's own order find the
/// boxes they need in cache.
class PointTree {
 public:
  explicit PointTree(PointsView points, const Context& context = {});

  Index size() const { return static_cast<Index>(order_.size()); }

  /// The cloud's indices along the curve: query in this order to stay in cache.
  const std::vector<std::int32_t>& order() const { return order_; }

  /// The nearest point whose squared distance is no more than `limit`; a good limit saves time.
  Neighbour nearest(const Vector3& query,
                    double limit = std::numeric_limits<double>::infinity()) const;

  /// The k nearest points, nearest first.
  void nearest(const Vector3& query, Index k, std::vector<Neighbour>& found) const;

  /// Queries that lie close together, answered in one descent: a mirror's images of points that
  /// follow each other along the curve. Column by column what nearest() gives; a column of NaN has
  /// no neighbour. `near`, a point's place in order(), is a guess where the answers lie.
  static constexpr int block = 8;
  using Queries = Eigen::Matrix<double, 3, block>;
  std::array<Neighbour, block> nearest(const Queries& queries, double limit, Index& near) const;

  /// The same for the k nearest points of each: column by column what nearest() with k gives.
  /// `reach`, infinite at first, is a guess at the square of how far they lie, and becomes it: what
  /// the block before needed spares this one from sorting what it does not.
  void nearest(const Queries& queries, Index k, Index near, double& reach,
               std::array<std::vector<Neighbour>, block>& found) const;

  /// visit(index, squared distance) for all points no farther than radius.
  template <typename Visit>
  void within(const Vector3& query, double radius, const Visit& visit) const {
    double limit = radius * radius;
    search(query, limit, [&](Index position, double squared) {
      if (squared <= limit) visit(static_cast<Index>(order_[position]), squared);
    });
  }

 private:
  static constexpr Index fan = 8;

  // Eight sibling boxes side by side, so that one pass over an array tests them all; in a unit of
  // their own.
  struct Boxes {
    std::array<std::array<float, fan>, 3> low, high;
  };

  // A coordinate from origin_ in the boxes' unit. What is farther off than squares can hold is
  // moved nearer, which prunes less.
  float in_boxes(double coordinate) const {
    constexpr double farthest = 1e18;
    return static_cast<float>(std::clamp(coordinate * to_boxes_, -farthest, farthest));
  }

  // Squared distances of the boxes from low..high, each side less by slack.
  static void measure_boxes(const Boxes* boxes, const float* low, const float* high, float slack,
                            float* squared);

  // Queries from origin_, coordinate by coordinate, and the box around them.
  struct Block {
    std::array<double, 3 * block> coordinates;
    std::array<float, 3> low, high;
  };

  // The k nearest of each, found among the points at `near` and then all others.
  void nearest_near(const Block& queries, Index k, Index near,
                    std::array<std::vector<Neighbour>, block>& found) const;
  // The same if no query needs to look farther than the root of `reach`; false where one does.
  bool nearest_within(const Block& queries, Index k, double reach,
                      std::array<std::vector<Neighbour>, block>& found) const;

  void sort(PointsView points, const Context& context);
  void stack_boxes(const Context& context);

  // Calls leaf(l) for every run l of `fan` points that may come nearer than sqrt(limit) to the box
  // low..high, near ones first; leaf may lower the limit as it goes.
  template <typename Leaf>
  void descend(const std::array<float, 3>& low, const std::array<float, 3>& high, double& limit,
               const Leaf& leaf) const;

  // Calls visit(position, squared distance) for every point that may be within `limit`.
  template <typename Visit>
  void search(const Vector3& query, double& limit, const Visit& visit) const;

  Vector3 origin_ = Vector3::Zero();
  double to_boxes_ = 1;  // from the cloud's unit
  float reach_ = 0;      // the largest extent, in the boxes' unit
  std::vector<std::int32_t> order_;
  std::vector<double> coordinates_;         // from origin_, along the curve
  std::vector<std::vector<Boxes>> levels_;  // leaves first; the last has one entry
};

template <typename Leaf>
void PointTree::descend(const std::array<float, 3>& low, const std::array<float, 3>& high,
                        double& limit, const Leaf& leaf) const {
  struct Node {
    std::int32_t level, index;
    float squared;
  };
  // Distances between boxes are in float, from rounded coordinates: never prune by less than this.
  float slack = reach_;
  for (int axis = 0; axis < 3; ++axis) slack += std::max(std::abs(low[axis]), std::abs(high[axis]));
  slack *= 4e-7f;

  const auto bound = [&] {
    constexpr double padding = std::numeric_limits<float>::max();  // lies farther, at infinity
    return std::min(limit * to_boxes_ * to_boxes_, padding);
  };
  std::array<Node, 8 * 16> stack;
  int top = 0;
  stack[top++] = {static_cast<std::int32_t>(levels_.size()) - 1, 0, 0.0f};
  while (top > 0) {
    const Node node = stack[--top];
    const double farthest = bound();
    if (node.squared > farthest) continue;
    if (node.level < 0) {
      leaf(node.index);
      continue;
    }
    const Boxes& boxes = levels_[node.level][node.index];
    std::array<float, fan> squared;
    measure_boxes(&boxes, low.data(), high.data(), slack, squared.data());
    const int first = top;
    for (int i = 0; i < fan; ++i) {
      if (squared[i] > farthest) continue;
      const Node child{node.level - 1, static_cast<std::int32_t>(node.index * fan + i), squared[i]};
      int at = top++;
      for (; at > first && stack[at - 1].squared < child.squared; --at) stack[at] = stack[at - 1];
      stack[at] = child;
    }
  }
}

template <typename Visit>
void PointTree::search(const Vector3& query, double& limit, const Visit& visit) const {
  const Vector3 q = query - origin_;
  const std::array<float, 3> at{in_boxes(q.x()), in_boxes(q.y()), in_boxes(q.z())};
  descend(at, at, limit, [&](Index leaf) {
    const Index end = std::min((leaf + 1) * fan, size());
    for (Index p = leaf * fan; p < end; ++p) {
      const double* x = &coordinates_[3 * p];
      const double dx = q.x() - x[0], dy = q.y() - x[1], dz = q.z() - x[2];
      visit(p, dx * dx + dy * dy + dz * dz);
    }
  });
}

}  // namespace symsurf
