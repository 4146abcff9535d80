#include "methods/thesis/along_normals.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/binary_unit.h"
#include "base/parallel.h"
#include "methods/thesis/box_tree.h"
#include "methods/thesis/line_queries.h"

namespace symsurf {

namespace {

constexpr Index block = LineQueries::block;

struct Partner {
  std::int32_t index;
  double squared;  // from the line
};

/// Points sorted so that the nearest to lines are found by branch and bound over boxes, eight lines
/// at once.
class LineSearch {
 public:
  LineSearch(PointsView points, const PointTree& tree, const Context& context)
      : points_(points), order_(tree.order()) {
    const Vector3 low = points.matrix().colwise().minCoeff(),
                  high = points.matrix().colwise().maxCoeff();
    centre_ = (low + high) / 2;
    const double extent = (high - low).maxCoeff();
    to_boxes_ = to_binary_unit(extent);
    // Single precision rounds a coordinate to 6e-8 of it, a distance takes ten of these.
    rounding_ = 4e-6f * static_cast<float>(to_boxes_ * extent / 2);
    interruptible_for(context, points.size(), [&](Index p) {
      const Eigen::Vector3f place = in_boxes(points[order_[p]]).cast<float>();
      tree_.add(place.x(), place.y(), place.z(), order_[p]);
    });
    tree_.build(context);
  }

  const std::vector<std::int32_t>& order() const { return order_; }
  LineQueries queries() const { return LineQueries(rounding_); }

  /// The partners of the block of points that begins at this position of the order. `partners` has
  /// those of the block before, which are good ones to begin with.
  void find(Index position, PointsView normals, LineQueries& queries,
            std::array<Partner, block>& partners) const {
    std::array<std::int32_t, block> index;
    LineQueries::Limits limits;
    for (int q = 0; q < block; ++q) {
      index[q] = order_[std::min<Index>(position + q, points_.size() - 1)];
      queries.set(q, in_boxes(points_[index[q]]), normals[index[q]], index[q]);
      Partner& partner = partners[q];
      partner.squared = partner.index == index[q] ? std::numeric_limits<double>::infinity()
                                                  : squared(index[q], normals, partner.index);
      const float reach = static_cast<float>(to_boxes_ * std::sqrt(partner.squared)) + rounding_;
      limits[q] = reach * reach;
    }
    queries.begin(limits);
    queries.lower_limits(tree_.runs()[position / block]);
    const auto consider = [&](int q, std::int32_t i) {
      const double d = squared(index[q], normals, i);
      Partner& partner = partners[q];
      if (d < partner.squared || (d == partner.squared && i < partner.index)) partner = {i, d};
    };
    // On the line itself only a lower index is better.
    const auto last = [&] {
      std::int32_t highest = 0;
      for (const Partner& partner : partners)
        highest = std::max(highest, partner.squared == 0 ? partner.index : any_index());
      return highest;
    };
    visit_nearest(tree_, queries, consider, last);
  }

 private:
  Vector3 in_boxes(const Vector3& x) const { return to_boxes_ * (x - centre_); }

  // Of the point j from the line through the point i.
  double squared(std::int32_t i, PointsView normals, std::int32_t j) const {
    const Vector3 w = points_[j] - points_[i], u = normals[i];
    const double along = w.x() * u.x() + w.y() * u.y() + w.z() * u.z();
    const double x = w.x() - along * u.x(), y = w.y() - along * u.y(), z = w.z() - along * u.z();
    return x * x + y * y + z * z;
  }

  PointsView points_;
  Vector3 centre_;
  double to_boxes_;
  float rounding_;
  const std::vector<std::int32_t>& order_;
  BoxTree tree_;
};

}  // namespace

Result pairs_along_normals(PointsView points, const PointTree& tree, PointsView normals,
                           const Context& context) {
  constexpr Index grain = 1024;
  static_assert(grain % block == 0);
  const LineSearch search(points, tree, context);
  Result result;
  result.pairs.resize(points.size(), 2);
  result.residuals.resize(points.size());
  result.surface_points.resize(points.size(), 3);
  parallel_for(context, points.size(), grain, [&](Index begin, Index end) {
    LineQueries queries = search.queries();
    std::array<Partner, block> partners;
    partners.fill({search.order()[begin], 0});
    for (Index first = begin; first < end; first += block) {
      search.find(first, normals, queries, partners);
      for (Index p = first; p < std::min(first + block, end); ++p) {
        const Index i = search.order()[p];
        const Partner& partner = partners[p - first];
        result.pairs.row(i) << i, partner.index;
        result.residuals[i] = std::sqrt(partner.squared);
        result.surface_points.row(i) = (points[i] + points[partner.index]).transpose() / 2;
      }
    }
  });
  return result;
}

}  // namespace symsurf
