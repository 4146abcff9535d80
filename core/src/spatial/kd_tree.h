#pragma once

#include <symsurf/context.h>
#include <symsurf/types.h>

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
      bool addPoint(double squared, std::uint32_t i) {
        if (squared < limit) limit = offer(i);
        return true;
      }
      bool full() const { return true; }
    } results{limit, offer};
    tree_.findNeighbors(results, query.data(), {});
  }

  /// The same with a distance of the caller's: bound(low, high) is no more than its square anywhere
  /// in the box of these corners. What lies in a leaf is offered unmeasured.
  template <typename Bound, typename Offer>
  void search_boxes(const Bound& bound, double limit, const Offer& offer) const {
    Part root{tree_.root_node, {}, {}};
    for (int axis = 0; axis < dimension; ++axis) {
      root.low[axis] = tree_.root_bbox[axis].low;
      root.high[axis] = tree_.root_bbox[axis].high;
    }
    descend(root, bound, limit, offer);
  }

 private:
  struct PointSource {
    std::vector<Point> points;
    const Context* building;
    mutable std::uint32_t reads = 0;

    std::size_t kdtree_get_point_count() const { return points.size(); }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const {
      constexpr std::uint32_t stretch = 1 << 20;  // some milliseconds
      if (++reads % stretch == 0) building->check();
      return points[i][static_cast<Index>(axis)];
    }
    template <typename Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };

  // In place of nanoflann's own, which would count as reads what queries compare.
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

  struct Part {
    const typename Tree::Node* node;
    Point low, high;
    double bound = 0;
  };

  template <typename Bound, typename Offer>
  void descend(const Part& part, const Bound& bound, double& limit, const Offer& offer) const {
    if (!part.node->child1) {
      const auto& leaf = part.node->node_type.lr;
      for (auto k = leaf.left; k < leaf.right; ++k) limit = offer(tree_.vAcc[k]);
      return;
    }
    const auto& split = part.node->node_type.sub;
    Part first{part.node->child1, part.low, part.high},
        second{part.node->child2, part.low, part.high};
    first.high[split.divfeat] = split.divlow;
    second.low[split.divfeat] = split.divhigh;
    for (Part* child : {&first, &second}) child->bound = bound(child->low, child->high);
    if (second.bound < first.bound) std::swap(first, second);
    for (const Part* child : {&first, &second})
      if (child->bound <= limit) descend(*child, bound, limit, offer);
  }

  PointSource points_;
  Tree tree_;
};

}  // namespace symsurf
