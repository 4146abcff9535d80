#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "cloud/kd_tree.h"

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

/// A k-d tree of a cloud: exact nearest neighbours, ties broken by index. The points are stored
/// along the Z-order curve, so that queries in that order stay in cache. Copies of a point are one
/// point of the tree: a search for few neighbours takes no longer however many there are. Points
/// that are not finite are never found.
class PointTree {
 public:
  explicit PointTree(PointsView points, const Context& context = {});

  Index size() const { return static_cast<Index>(order_.size()); }

  /// The cloud's indices along the Z-order curve; last those of points that are not finite.
  const std::vector<std::int32_t>& order() const { return order_; }

  /// The nearest point whose squared distance is no more than `limit`; none to a query that is not
  /// finite.
  Neighbour nearest(const Vector3& query,
                    double limit = std::numeric_limits<double>::infinity()) const;

  /// The k nearest points, nearest first.
  void nearest(const Vector3& query, Index k, std::vector<Neighbour>& found) const;

  /// visit(index, squared distance) for all points no farther than radius.
  template <typename Visit>
  void within(const Vector3& query, double radius, const Visit& visit) const {
    const double limit = radius * radius;
    search(query, limit, [&](std::size_t begin, std::size_t end, double squared) {
      if (squared <= limit)
        for (std::size_t p = begin; p < end; ++p) visit(order_[p], squared);
      return limit;
    });
  }

  /// KdTree::search_boxes(): bound(low, high) of boxes, offer(index) of points.
  template <typename Bound, typename Offer>
  void search_boxes(const Bound& bound, double limit, const Offer& offer) const {
    if (!tree_) return;
    tree_->search_boxes(
        [&](const Vector3& low, const Vector3& high) {
          return bound(Vector3(low + origin_), Vector3(high + origin_));
        },
        limit,
        [&](std::uint32_t node) {
          double left = limit;
          for (std::size_t p = begin(node); p < begin(node + 1); ++p)
            left = offer(Index{order_[p]});
          return left;
        });
  }

 private:
  using Tree = KdTree<3>;

  // In the order, where the copies of the tree's point begin.
  std::size_t begin(std::size_t node) const { return begins_.empty() ? node : begins_[node]; }

  // Calls limit = offer(begin, end, squared distance) for what may lie within the root of `limit`:
  // positions in the order of a point and its copies, the lowest index first.
  template <typename Offer>
  void search(const Vector3& query, double limit, const Offer& offer) const {
    const Vector3 q = query - origin_;
    if (!tree_ || !q.allFinite()) return;
    tree_->search(q, Tree::at_most(limit), [&](std::uint32_t node, double squared) {
      return Tree::at_most(offer(begin(node), begin(node + 1), squared));
    });
  }

  void sort(PointsView points, double extent, const Context& context);
  void put_copies_together(PointsView points, const std::vector<std::uint64_t>& keys,
                           const Context& context);

  Vector3 origin_ = Vector3::Zero();
  std::vector<std::int32_t> order_;
  std::vector<std::int32_t> begins_;  // of the tree's points and the end; empty: none has copies
  std::unique_ptr<const Tree> tree_;  // of the distinct finite points from origin_, on the curve
};

}  // namespace symsurf
