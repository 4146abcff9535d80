#pragma once

#include <symsurf/context.h>
#include <symsurf/types.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <nanoflann.hpp>
#include <utility>
#include <vector>

namespace symsurf {

/// A k-d tree (nanoflann) of points in a few dimensions, for searches whose caller measures the
/// candidates: PointTree knows distances in space alone, and ties of those.
template <int dimension>
class KdTree {
 public:
  using Point = Eigen::Matrix<double, dimension, 1>;

  /// At least one point. Asks the context, while it builds, whether to go on.
  KdTree(std::vector<Point> points, const Context& context)
      : points_{std::move(points), &context}, tree_(dimension, points_) {}
  KdTree(const KdTree&) = delete;

  /// Calls limit = offer(i) for each point i closer to the query than the root of `limit`, near
  /// ones first, as long as there are any.
  template <typename Offer>
  void search(const Point& query, double limit, const Offer& offer) const {
    struct ResultSet {
      double limit;
      const Offer& offer;

      double worstDist() const { return limit; }
      bool addPoint(double, std::uint32_t i) {
        limit = offer(i);
        return true;
      }
      bool full() const { return true; }
    } results{limit, offer};
    tree_.findNeighbors(results, query.data(), {});
  }

  /// The same with a distance of the caller's: squared(centre, half) is a lower bound on its square
  /// anywhere in the box centre ± half.
  template <typename Squared, typename Offer>
  void search_boxes(const Squared& squared, double limit, const Offer& offer) const {
    Box box;
    for (int axis = 0; axis < dimension; ++axis)
      box[axis] = {tree_.root_bbox[axis].low, tree_.root_bbox[axis].high};
    descend(tree_.root_node, box, squared, limit, offer);
  }

 private:
  struct PointSource {
    std::vector<Point> points;
    const Context* building;
    mutable std::uint32_t reads = 0;

    std::size_t kdtree_get_point_count() const { return points.size(); }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const {
      constexpr std::uint32_t stretch = 1 << 20;  // a few milliseconds
      if (++reads % stretch == 0) building->check();
      return points[i][static_cast<Index>(axis)];
    }
    template <typename BoundingBox>
    bool kdtree_get_bbox(BoundingBox&) const {
      return false;
    }
  };

  // In place of nanoflann's own, which reads the points by kdtree_get_pt() on any thread.
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
  using Box = std::array<std::array<double, 2>, dimension>;

  template <typename Squared, typename Offer>
  void descend(const typename Tree::Node* node, const Box& box, const Squared& squared,
               double& limit, const Offer& offer) const {
    if (!node->child1) {
      for (auto k = node->node_type.lr.left; k < node->node_type.lr.right; ++k)
        limit = offer(tree_.vAcc[k]);
      return;
    }
    const auto bound = [&](const Box& part) {
      Point low, high;
      for (int axis = 0; axis < dimension; ++axis) {
        low[axis] = part[axis][0];
        high[axis] = part[axis][1];
      }
      return squared((low + high) / 2, (high - low) / 2);
    };
    const auto& split = node->node_type.sub;
    Box first = box, second = box;
    first[split.divfeat][1] = split.divlow;
    second[split.divfeat][0] = split.divhigh;
    const double to_first = bound(first), to_second = bound(second);
    const auto enter_first = [&] {
      if (to_first <= limit) descend(node->child1, first, squared, limit, offer);
    };
    const bool is_first_nearer = to_first <= to_second;
    if (is_first_nearer) enter_first();
    if (to_second <= limit) descend(node->child2, second, squared, limit, offer);
    if (!is_first_nearer) enter_first();
  }

  PointSource points_;
  Tree tree_;
};

}  // namespace symsurf
