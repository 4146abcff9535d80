#pragma once

#include <symsurf/context.h>
#include <symsurf/points_view.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <nanoflann.hpp>
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

/// A k-d tree of a cloud: exact nearest neighbours, ties broken by index (nanoflann). The points
/// are stored along the Z-order curve, so that queries in that order stay in cache. Points that are
/// not finite are never found.
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
    search(query, WithinRadius<Visit>{radius * radius, visit, order_.data()});
  }

 private:
  // Coordinates from the middle of the cloud, point by point along the curve.
  struct SortedPoints {
    std::vector<double> coordinates;
    const Context* building;  // checked for cancellation while the tree is built

    std::size_t kdtree_get_point_count() const { return coordinates.size() / 3; }
    // Read by the construction alone, which passes over all points on every level of the tree.
    double kdtree_get_pt(std::size_t i, std::size_t axis) const {
      constexpr std::size_t stretch = 1 << 16;  // points, a fraction of a millisecond
      if (i % stretch == 0) building->check();
      return coordinates[3 * i + axis];
    }
    template <typename Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };

  // nanoflann's own metric would count as reads what queries compare.
  struct SquaredDistance {
    using ElementType = double;
    using DistanceType = double;

    explicit SquaredDistance(const SortedPoints& points) : points(points) {}
    double evalMetric(const double* query, std::int32_t position, std::size_t) const {
      const double* x = &points.coordinates[3 * static_cast<std::size_t>(position)];
      const double dx = query[0] - x[0], dy = query[1] - x[1], dz = query[2] - x[2];
      return dx * dx + dy * dy + dz * dz;
    }
    double accum_dist(double a, double b, std::size_t) const { return (a - b) * (a - b); }

    const SortedPoints& points;
  };

  using KdTree =
      nanoflann::KDTreeSingleIndexAdaptor<SquaredDistance, SortedPoints, 3, std::int32_t>;

  struct Nodes {
    explicit Nodes(SortedPoints sorted);

    SortedPoints points;
    KdTree tree;
  };

  // What nanoflann calls a result set: told of candidates nearer than worstDist(), it decides. That
  // is a little beyond the limit, since the tree compares with "<" and its bounds are rounded.
  template <typename Visit>
  struct WithinRadius {
    double limit;
    const Visit& visit;
    const std::int32_t* order;

    double worstDist() const { return padded(limit); }
    bool addPoint(double squared, std::int32_t position) const {
      if (squared <= limit) visit(static_cast<Index>(order[position]), squared);
      return true;
    }
    bool full() const { return true; }
    void sort() const {}
  };
  static double padded(double squared) { return squared * (1 + 1e-12) + 1e-300; }

  struct Nearest;
  struct NearestFew;

  template <typename ResultSet>
  void search(const Vector3& query, ResultSet&& found) const {
    const Vector3 q = query - origin_;
    if (nodes_ && q.allFinite()) nodes_->tree.findNeighbors(found, q.data(), {});
  }

  void sort(PointsView points, double extent, const Context& context);

  Vector3 origin_ = Vector3::Zero();
  std::vector<std::int32_t> order_;
  std::unique_ptr<const Nodes> nodes_;  // none where no point is finite
};

}  // namespace symsurf
