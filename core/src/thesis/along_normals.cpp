#include "along_normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "../box_tree.h"
#include "../parallel.h"
#include "../point_tree.h"
#include "../vectorised.h"

namespace symsurf {

namespace {

constexpr int fan = BoxTree::fan;

// A run of points: their x, their y, their z.
using Run = std::array<double, 3 * fan>;

// Squared distances of a run of points from the line through the origin along `unit`; in the order
// of operations that an oracle would choose.
SYMSURF_VECTORISED void squared_from_line(const double* run, const double* start,
                                          const double* unit, double* __restrict squared) {
  const double sx = start[0], sy = start[1], sz = start[2];
  const double ux = unit[0], uy = unit[1], uz = unit[2];
  for (int i = 0; i < fan; ++i) {
    const double wx = run[i] - sx, wy = run[fan + i] - sy, wz = run[2 * fan + i] - sz;
    const double along = wx * ux + wy * uy + wz * uz;
    const double x = wx - along * ux, y = wy - along * uy, z = wz - along * uz;
    squared[i] = x * x + y * y + z * z;
  }
}

// An axis across a line, and where the line lies on it.
struct AxisAcross {
  std::array<float, 3> half;  // of the axis
  float at;
};

// A box lies no nearer to a line than its shadow on two axes across the line.
SYMSURF_VECTORISED void bound_from_line(const BoxTree::Boxes* boxes, const AxisAcross* across,
                                        float slack, BoxTree::Bounds* squared) {
  const Floats *low = reinterpret_cast<const Floats*>(&boxes->low),
               *high = reinterpret_cast<const Floats*>(&boxes->high);
  const Floats zero{};
  Floats sum = zero;
  for (int k = 0; k < 2; ++k) {
    const auto& [half, at] = across[k];
    const Floats gap = half[0] * (high[0] + low[0]) + half[1] * (high[1] + low[1]) +
                       half[2] * (high[2] + low[2]) - at;
    const Floats reach = std::abs(half[0]) * (high[0] - low[0]) +
                         std::abs(half[1]) * (high[1] - low[1]) +
                         std::abs(half[2]) * (high[2] - low[2]) + slack;
    const Floats beyond = (gap > zero ? gap : -gap) - reach;
    const Floats outside = beyond > zero ? beyond : zero;
    sum += outside * outside;
  }
  *reinterpret_cast<Floats*>(squared) = sum;
}

/// Points sorted so that the nearest to a line is found by branch and bound over boxes.
class LineSearch {
 public:
  LineSearch(PointsView points, const Context& context)
      : centre_((points.matrix().colwise().minCoeff() + points.matrix().colwise().maxCoeff()) / 2),
        runs_((points.size() + fan - 1) / fan) {
    std::vector<Vector3> places(points.size());
    for (Index i = 0; i < points.size(); ++i) places[i] = points[i] - centre_;
    indices_ = z_order(places, context);
    interruptible_for(context, points.size(), [&](Index p) {
      const Vector3 x = points[indices_[p]];
      places[p] = x - centre_;
      for (int axis = 0; axis < 3; ++axis) runs_[p / fan][axis * fan + p % fan] = x[axis];
    });
    boxes_.emplace(places, indices_, context);
  }

  const std::vector<std::int32_t>& order() const { return indices_; }

  /// The nearest to the line along `unit` through the point at `position` of the order, not itself.
  /// `near` is a guess at the answer's position, and becomes it.
  Neighbour nearest(Index position, const Vector3& unit, Index& near) const {
    const Vector3 x = place(position);
    Neighbour best;
    std::array<double, fan> squared;
    const auto scan = [&](Index begin, Index end) {
      squared_from_line(runs_[begin / fan].data(), x.data(), unit.data(), squared.data());
      for (Index p = begin; p < end; ++p) {
        if (squared[p - begin] > best.squared_distance || p == position) continue;
        const Neighbour found{indices_[p], squared[p - begin]};
        if (!(found < best)) continue;
        best = found;
        near = p;
      }
    };
    const Index size = static_cast<Index>(indices_.size());
    const Index guess = near / fan * fan;
    scan(guess, std::min(guess + fan, size));

    const Vector3 e1 = unit.unitOrthogonal(), e2 = unit.cross(e1), w = x - centre_;
    const auto across = [&](const Vector3& e) -> AxisAcross {
      const Eigen::Vector3f half = e.cast<float>() / 2;
      return {{half[0], half[1], half[2]}, static_cast<float>(e.dot(w))};
    };
    const std::array<AxisAcross, 2> axes{across(e1), across(e2)};
    const float slack = 4 * boxes_->slack();
    const auto bound = [&](const BoxTree::Boxes& boxes, BoxTree::Bounds& least) {
      bound_from_line(&boxes, axes.data(), slack, &least);
      if (best.squared_distance == 0)
        for (int i = 0; i < fan; ++i)
          if (boxes.first[i] > best.index) least[i] = std::numeric_limits<float>::infinity();
    };
    boxes_->descend(bound, best.squared_distance, [&](Index begin, Index end) {
      if (begin != guess) scan(begin, end);
    });
    return best;
  }

 private:
  Vector3 place(Index p) const {
    const Run& run = runs_[p / fan];
    return {run[p % fan], run[fan + p % fan], run[2 * fan + p % fan]};
  }

  Vector3 centre_;
  std::vector<Run> runs_;  // as given
  std::vector<std::int32_t> indices_;
  std::optional<BoxTree> boxes_;
};

}  // namespace

Result pairs_along_normals(PointsView points, PointsView normals, const Context& context) {
  constexpr Index grain = 1024;
  const LineSearch search(points, context);
  Result result;
  result.pairs.resize(points.size(), 2);
  result.residuals.resize(points.size());
  result.surface_points.resize(points.size(), 3);
  parallel_for(context, points.size(), grain, [&](Index begin, Index end) {
    Index near = begin;
    for (Index p = begin; p < end; ++p) {
      const Index i = search.order()[p];
      const Neighbour partner = search.nearest(p, normals[i], near);
      result.pairs.row(i) << i, partner.index;
      result.residuals[i] = std::sqrt(partner.squared_distance);
      result.surface_points.row(i) = (points[i] + points[partner.index]).transpose() / 2;
    }
  });
  return result;
}

}  // namespace symsurf
