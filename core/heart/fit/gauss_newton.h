#pragma once

#include <Eigen/Core>

#include "base/linear_algebra.h"
#include "pairing/correspondence.h"

namespace symsurf {

/// One Gauss-Newton step of a map by its numbers: sums weighted squared gaps between images and
/// partners, in their metrics. `Map::slopes(x)`: by how much each number moves the image of x;
/// `Map::stepped(change)`: the map after a change that is cut to what is small, and its length;
/// `Map::ridge`: of the trace, what holds numbers that nothing else does.
template <typename Map>
class GaussNewton {
 public:
  using Change = typename Map::Change;
  static constexpr int size = Change::RowsAtCompileTime;
  using Hessian = Eigen::Matrix<double, size, size>;

  /// `map`: one that sends x to the image that is `gap` past its partner.
  void add(const Map& map, const Vector3& x, const Vector3& gap, const Metric& metric,
           double weight) {
    const Eigen::Matrix<double, 3, size> slopes = map.slopes(x);
    const Change across = slopes.transpose() * metric.normal;
    const double off = weight * metric.off_surface, all = weight * metric.isotropic;
    hessian_.noalias() += off * across * across.transpose();
    gradient_ += off * metric.normal.dot(gap) * across;
    if (all == 0) return;
    hessian_.noalias() += all * (slopes.transpose() * slopes);
    gradient_.noalias() += all * (slopes.transpose() * gap);
  }

  const Hessian& hessian() const { return hessian_; }
  const Change& gradient() const { return gradient_; }

  /// The map after the step, and how far its numbers moved; the same one where nothing holds it.
  std::pair<Map, double> taken(const Map& map) const {
    const Hessian damped =
        hessian_ + Hessian((Map::ridge * hessian_.trace() + 1e-300) * Hessian::Identity());
    return map.stepped(solved(damped, Change(-gradient_)));
  }

 private:
  Hessian hessian_ = Hessian::Zero();
  Change gradient_ = Change::Zero();
};

}  // namespace symsurf
