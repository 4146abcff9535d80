#include "along_normals.h"

#include <Eigen/Geometry>
#include <cmath>
#include <optional>

#include "../box_tree.h"
#include "../parallel.h"
#include "../point_tree.h"

namespace symsurf {

namespace {

double squared_from_line(const Vector3& w, const Vector3& unit) {
  const double along = w.x() * unit.x() + w.y() * unit.y() + w.z() * unit.z();
  const double x = w.x() - along * unit.x(), y = w.y() - along * unit.y(),
               z = w.z() - along * unit.z();
  return x * x + y * y + z * z;
}

/// Points sorted so that the nearest to a line is found by branch and bound over boxes.
class LineSearch {
 public:
  explicit LineSearch(PointsView points)
      : centre_((points.matrix().colwise().minCoeff() + points.matrix().colwise().maxCoeff()) / 2),
        places_(points.size()),
        sorted_(points.size()) {
    for (Index i = 0; i < points.size(); ++i) places_[i] = points[i] - centre_;
    indices_ = z_order(places_);
    for (std::size_t p = 0; p < places_.size(); ++p) {
      places_[p] = points[indices_[p]] - centre_;
      sorted_[p] = points[indices_[p]];
    }
    boxes_.emplace(places_, indices_);
  }

  const std::vector<std::int32_t>& order() const { return indices_; }

  /// The nearest to the line along `unit` through the point at `position` of the order, not itself.
  Neighbour nearest(Index position, const Vector3& unit) const {
    const Vector3 x = sorted_[position];
    Neighbour best;
    const auto consider = [&](Index p) {
      if (p == position) return;
      const Neighbour found{indices_[p], squared_from_line(sorted_[p] - x, unit)};
      if (found < best) best = found;
    };
    consider(position > 0 ? position - 1 : position + 1);

    // A box lies no nearer to the line than its rectangle in two axes across the line.
    const Vector3 e1 = unit.unitOrthogonal(), e2 = unit.cross(e1);
    const std::array<Eigen::Vector3f, 2> axes{e1.cast<float>(), e2.cast<float>()};
    const std::array<float, 2> at{static_cast<float>(e1.dot(places_[position])),
                                  static_cast<float>(e2.dot(places_[position]))};
    const float slack = 4 * boxes_->slack();
    const auto bound = [&](const BoxTree::Boxes& boxes, BoxTree::Bounds& squared) {
      squared.fill(0);
      for (int k = 0; k < 2; ++k) {
        std::array<float, 8> gap;
        gap.fill(-at[k]);
        std::array<float, 8> reach;
        reach.fill(slack);
        for (int axis = 0; axis < 3; ++axis) {
          const float along = axes[k][axis] / 2, half = std::abs(along);
          for (int i = 0; i < 8; ++i) {
            gap[i] += along * (boxes.high[axis][i] + boxes.low[axis][i]);
            reach[i] += half * (boxes.high[axis][i] - boxes.low[axis][i]);
          }
        }
        for (int i = 0; i < 8; ++i) {
          const float outside = std::max(std::abs(gap[i]) - reach[i], 0.0f);
          squared[i] += outside * outside;
        }
      }
      if (best.squared_distance == 0)
        for (int i = 0; i < 8; ++i)
          if (boxes.first[i] > best.index) squared[i] = std::numeric_limits<float>::infinity();
    };
    boxes_->descend(bound, best.squared_distance, [&](Index begin, Index end) {
      for (Index p = begin; p < end; ++p) consider(p);
    });
    return best;
  }

 private:
  Vector3 centre_;
  std::vector<Vector3> places_;  // from centre_
  std::vector<Vector3> sorted_;  // as given
  std::vector<std::int32_t> indices_;
  std::optional<BoxTree> boxes_;
};

}  // namespace

Result pairs_along_normals(PointsView points, PointsView normals, const Context& context) {
  constexpr Index grain = 1024;
  const LineSearch search(points);
  Result result;
  result.pairs.resize(points.size(), 2);
  result.residuals.resize(points.size());
  result.surface_points.resize(points.size(), 3);
  parallel_for(context, points.size(), grain, [&](Index begin, Index end) {
    for (Index p = begin; p < end; ++p) {
      const Index i = search.order()[p];
      const Neighbour partner = search.nearest(p, normals[i]);
      result.pairs.row(i) << i, partner.index;
      result.residuals[i] = std::sqrt(partner.squared_distance);
      result.surface_points.row(i) = (points[i] + points[partner.index]).transpose() / 2;
    }
  });
  return result;
}

}  // namespace symsurf
