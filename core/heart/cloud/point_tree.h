#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <nanoflann.hpp>
#include <utility>
#include <vector>

#include "cloud/box_tree.h"

namespace symsurf {

struct Cloud;

/// A k-d tree (nanoflann) of points in a few dimensions. Searches offer candidates to the caller,
/// who decides about them and how far to look on; PointTree is what most callers want.
template <int dimension>
class KdTree {
 public:
  using Point = Eigen::Matrix<double, dimension, 1>;

  /// At least one point, all finite. Checks the context for cancellation while it builds.
  KdTree(std::vector<Point> points, const Context& context)
      : points_{std::move(points), &context}, tree_(dimension, points_, leaf_size) {
    points_.building = nullptr;
  }
  KdTree(const KdTree&) = delete;

  /// Calls limit = offer(i, squared distance) for each point i whose squared distance from the
  /// query is less than `limit`, near ones first, as long as there are any. To see all points at a
  /// limit, ties among them, let limits be at_most() it.
  template <typename Offer>
  void search(const Point& query, double limit, const Offer& offer) const {
    struct ResultSet {
      double limit;
      const Offer& offer;

      double worstDist() const { return limit; }
      bool addPoint(double squared, std::uint32_t i) {
        if (squared < limit) limit = offer(i, squared);
        return true;
      }
      bool full() const { return true; }
    } results{limit, offer};
    tree_.findNeighbors(results, query.data(), {});
  }

 private:
  static constexpr std::size_t leaf_size = 16;  // points; of 4 to 24 the fastest up to 10^6 points

  struct PointSource {
    std::vector<Point> points;
    const Context* building;

    std::size_t kdtree_get_point_count() const { return points.size(); }
    // For the construction alone, which passes over all points on every level of the tree.
    double kdtree_get_pt(std::size_t i, std::size_t axis) const {
      constexpr std::size_t stretch = 1 << 16;  // points, a fraction of a millisecond
      if (i % stretch == 0) [[unlikely]]
        building->check();
      return points[i][static_cast<Index>(axis)];
    }
    template <typename Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };

  // In place of nanoflann's own, which reads by kdtree_get_pt.
  struct SquaredDistance {
    using ElementType = double;
    using DistanceType = double;
    const PointSource& source;

    explicit SquaredDistance(const PointSource& points) : source(points) {}
    double evalMetric(const double* query, std::uint32_t i, std::size_t) const {
      return (source.points[i] - Eigen::Map<const Point>(query)).squaredNorm();
    }
    double accum_dist(double a, double b, std::size_t) const { return (a - b) * (a - b); }
  };

  using Tree = nanoflann::KDTreeSingleIndexAdaptor<SquaredDistance, PointSource, dimension>;

  PointSource points_;
  Tree tree_;
};

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

/// A tree of a cloud: exact nearest neighbours, ties broken by index. The points are stored
/// along the Z-order curve, so that queries in that order stay in cache. Copies of a point are one
/// point of the tree: a search for few neighbours takes no longer however many there are. Points
/// that are not finite are never found.
class PointTree {
 public:
  explicit PointTree(PointsView points, const Context& context = {});

  Index size() const { return static_cast<Index>(order_.size()); }

  /// Whether some points are equal.
  bool has_copies() const { return !begins_.empty(); }

  /// The cloud's indices along the Z-order curve; last those of points that are not finite.
  const std::vector<std::int32_t>& order() const { return order_; }

  /// The nearest point whose squared distance is no more than `limit`; none to a query that is not
  /// finite.
  Neighbour nearest(const Vector3& query,
                    double limit = std::numeric_limits<double>::infinity()) const;

  /// The same of many queries, which are fastest where those next to each other are near.
  std::vector<Neighbour> nearest(const std::vector<Vector3>& queries,
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

  /// BoxTree::search_boxes(): bound(low, high) of boxes, offer(index) of points.
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
  using Tree = BoxTree;

  // In the order, where the copies of the tree's point begin.
  std::size_t begin(std::size_t node) const { return begins_.empty() ? node : begins_[node]; }

  // Calls limit = offer(begin, end, squared distance) for what may lie within the root of `limit`:
  // positions in the order of a point and its copies, the lowest index first.
  template <typename Offer>
  void search(const Vector3& query, double limit, const Offer& offer) const {
    const Vector3 q = query - origin_;
    if (!tree_ || !q.allFinite()) return;
    tree_->search(q, at_most(limit), [&](std::uint32_t node, double squared) {
      return at_most(offer(begin(node), begin(node + 1), squared));
    });
  }

  // Gives the keys on the curve, in its order.
  std::vector<std::uint64_t> sort(PointsView points, double extent, const Context& context);
  void put_copies_together(PointsView points, const std::vector<std::uint64_t>& keys,
                           const Context& context);

  Vector3 origin_ = Vector3::Zero();
  std::vector<std::int32_t> order_;
  std::vector<std::int32_t> begins_;  // of the tree's points and the end; empty: none has copies
  std::unique_ptr<const Tree> tree_;  // of the distinct finite points from origin_, on the curve
};

/// Nearest points of a cloud to many queries.
class NearestPoints {
 public:
  /// Until the cloud's tree is released.
  NearestPoints(const Cloud& cloud, const Context& context);

  /// The nearest point to each query, NaN where none is within `reach`.
  std::vector<Vector3> nearest(const std::vector<Vector3>& queries, double reach) const;

  /// The nearest but one, copies of the nearest left out; of a single position, that one.
  std::vector<Vector3> second_nearest(const std::vector<Vector3>& queries) const;

 private:
  Vector3 second_nearest(const Vector3& query) const;

  PointsView points_;
  const PointTree& tree_;
  const Context context_;
};

}  // namespace symsurf
