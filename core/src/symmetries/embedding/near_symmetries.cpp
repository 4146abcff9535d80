#include "symmetries/embedding/near_symmetries.h"

#include <algorithm>
#include <cmath>

#include "base/math.h"
#include "base/nearest_orthogonal.h"
#include "cloud/farthest_points.h"

namespace symsurf {

namespace {

constexpr double rounding = 1e-6;  // diameters between an image and its partner: single precision
constexpr double least_radius = 0.3;     // of the largest, of points that define a map
constexpr double least_sine = 0.3;       // of the angle between two of them
constexpr Index most_bases = 4'000'000;  // pairs that are tried for the base
constexpr std::size_t most_exact = 512, most_near = 32;  // maps
constexpr Index landmarks = 120;                         // of points without exact partners
constexpr Index compared = 1000;         // points that an approximate map is fitted to
constexpr std::size_t most_fitted = 96;  // approximate maps that are
constexpr int fitting_steps = 20;
constexpr double same_guess = 0.3;  // of two that are not fitted yet
constexpr double same_map = 0.1;    // Frobenius norm of the difference of two rotations: 4 degrees

using Maps = std::vector<NearSymmetry>;

class Search {
 public:
  Search(PointsView points, const PointTree& tree, const Context& context)
      : tree_(tree), context_(context) {
    found_.centre = points.matrix().colwise().mean().transpose();
    rows_ = (points.matrix().rowwise() - found_.centre.transpose()).transpose();
    radii_ = rows_.colwise().norm();
    found_.diameter = 2 * radii_.maxCoeff();
    found_.maps = {{Eigen::Isometry3d::Identity(), 0}};
  }

  NearSymmetries run(double tolerance) {
    add_exact();  // of a planar cloud also the reflection in its plane
    if (!found_.exact) add_near(tolerance);
    return std::move(found_);
  }

 private:
  using Columns = Eigen::Matrix<double, 3, Eigen::Dynamic>;

  double tolerance() const { return rounding * found_.diameter; }

  // By which the base is known among the points: the fewer alike the fewer maps to try.
  std::vector<Index> as_far(double radius, double within) const {
    std::vector<Index> alike;
    for (Index i = 0; i < radii_.size(); ++i)
      if (std::abs(radii_[i] - radius) <= within) alike.push_back(i);
    return alike;
  }

  // Of each point how many have its radius.
  std::vector<Index> counts_of_radii() const {
    std::vector<double> sorted(radii_.begin(), radii_.end());
    std::sort(sorted.begin(), sorted.end());
    std::vector<Index> counts;
    for (const double radius : radii_)
      counts.push_back(std::upper_bound(sorted.begin(), sorted.end(), radius + tolerance()) -
                       std::lower_bound(sorted.begin(), sorted.end(), radius - tolerance()));
    return counts;
  }

  bool is_wide(Index a, Index b) const {
    return rows_.col(a).cross(rows_.col(b)).norm() > least_sine * radii_[a] * radii_[b];
  }

  static Matrix3 frame(const Vector3& one, const Vector3& other) {
    Matrix3 axes;
    axes.col(0) = one.normalized();
    axes.col(2) = one.cross(other).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    return axes;
  }

  Vector3 image(const Eigen::Isometry3d& map, Index i) const {
    return map * (Vector3(rows_.col(i)) + found_.centre);
  }

  Eigen::Isometry3d about_centre(const Matrix3& linear) const {
    Eigen::Isometry3d map = Eigen::Isometry3d::Identity();
    map.linear() = linear;
    map.translation() = found_.centre - linear * found_.centre;
    return map;
  }

  bool is_known(const Maps& maps, const Matrix3& linear, double apart) const {
    return std::any_of(maps.begin(), maps.end(), [&](const NearSymmetry& other) {
      return (other.map.linear() - linear).norm() < apart;
    });
  }

  void add_exact() {
    const std::vector<Index> counts = counts_of_radii();
    const double least = least_radius * found_.diameter / 2;
    const auto rarest = [&](const auto& allowed) {
      Index best = -1;
      for (Index i = 0; i < radii_.size(); ++i)
        if (radii_[i] >= least && allowed(i) &&
            (best < 0 || counts[i] < counts[best] ||
             (counts[i] == counts[best] && radii_[i] > radii_[best])))
          best = i;
      return best;
    };
    const Index a = rarest([](Index) { return true; });
    const Index b = rarest([&](Index i) { return is_wide(a, i); });
    if (b < 0) return;
    const std::vector<Index> as_a = as_far(radii_[a], tolerance());
    const std::vector<Index> as_b = as_far(radii_[b], tolerance());
    const auto pairs = static_cast<Index>(as_a.size() * as_b.size());
    const auto stride = static_cast<std::size_t>(std::max<Index>(1, pairs / most_bases));
    const double apart = (rows_.col(a) - rows_.col(b)).norm();
    const Matrix3 base = frame(rows_.col(a), rows_.col(b));
    for (std::size_t i = 0; i < as_a.size(); i += stride) {
      context_.check();
      for (const Index j : as_b) {
        if (std::abs((rows_.col(as_a[i]) - rows_.col(j)).norm() - apart) > 2 * tolerance())
          continue;
        const Matrix3 onto = frame(rows_.col(as_a[i]), rows_.col(j));
        for (const double side : {1.0, -1.0})
          add_if_exact(onto * Vector3(1, 1, side).asDiagonal() * base.transpose());
        if (found_.maps.size() >= most_exact) return;
      }
    }
  }

  void add_if_exact(const Matrix3& linear) {
    const Eigen::Isometry3d map = about_centre(linear);
    constexpr double apart = 1e-4;  // two turns of less than that are one
    if (is_known(found_.maps, linear, apart)) return;
    const double limit = 4 * tolerance() * tolerance();
    double squares = 0;
    bool moves = false;
    for (Index i = 0; i < rows_.cols(); ++i) {
      const Neighbour partner = tree_.nearest(image(map, i), limit);
      if (partner.index < 0) return;
      squares += partner.squared_distance;
      moves = moves || partner.index != i;
    }
    found_.exact = found_.exact || moves;
    found_.maps.push_back(
        {map, std::sqrt(squares / static_cast<double>(rows_.cols())) / found_.diameter});
  }

  double deviation(const Eigen::Isometry3d& map, const std::vector<Index>& points) const {
    const Eigen::Isometry3d back = map.inverse();
    double squares = 0;
    for (const Index i : points)
      squares += tree_.nearest(image(map, i)).squared_distance +
                 tree_.nearest(image(back, i)).squared_distance;
    return std::sqrt(squares / (2 * static_cast<double>(points.size()))) / found_.diameter;
  }

  // The orthogonal map that takes points nearest to those nearest to their images (Umeyama 1991).
  Eigen::Isometry3d fitted(Eigen::Isometry3d map, const std::vector<Index>& points) const {
    const double parity = map.linear().determinant() < 0 ? -1 : 1;
    for (int step = 0; step < fitting_steps; ++step) {
      Vector3 from = Vector3::Zero(), onto = Vector3::Zero();
      Matrix3 products = Matrix3::Zero();
      for (const Index i : points) {
        const Vector3 x = rows_.col(i);
        const Vector3 y = rows_.col(tree_.nearest(image(map, i)).index);
        from += x;
        onto += y;
        products += y * x.transpose();
      }
      const auto count = static_cast<double>(points.size());
      products -= onto * from.transpose() / count;
      const Matrix3 linear = nearest_orthogonal(products, parity);
      map = about_centre(linear);
      map.pretranslate((onto - linear * from) / count);
    }
    return map;
  }

  void add_near(double tolerance) {
    const std::vector<Index> few =
        farthest_points({rows_.data(), rows_.cols()}, landmarks, context_);
    std::vector<Index> many;
    for (Index i = 0; i < radii_.size(); i += std::max<Index>(1, radii_.size() / compared))
      many.push_back(i);
    const Index a = few.front();
    Index b = -1;
    for (const Index i : few)
      if (is_wide(a, i) && (b < 0 || radii_[i] > radii_[b])) b = i;
    if (b < 0) return;
    // How far an image lies from the nearest landmark at most.
    const double within = (rows_.col(few.back()) - rows_.col(nearest_before(few))).norm();
    const double apart = (rows_.col(a) - rows_.col(b)).norm();
    const Matrix3 base = frame(rows_.col(a), rows_.col(b));
    Maps rough;
    for (const Index i : few) {
      context_.check();
      if (std::abs(radii_[i] - radii_[a]) > within) continue;
      for (const Index j : few) {
        if (std::abs(radii_[j] - radii_[b]) > within ||
            !(rows_.col(i).cross(rows_.col(j)).norm() > 0) ||
            std::abs((rows_.col(i) - rows_.col(j)).norm() - apart) > 2 * within)
          continue;
        const Matrix3 onto = frame(rows_.col(i), rows_.col(j));
        for (const double side : {1.0, -1.0}) {
          const Eigen::Isometry3d map =
              about_centre(onto * Vector3(1, 1, side).asDiagonal() * base.transpose());
          rough.push_back({map, deviation(map, few)});
        }
      }
    }
    std::stable_sort(rough.begin(), rough.end(), [](const auto& one, const auto& other) {
      return one.deviation < other.deviation;
    });
    suppress_non_maxima(rough, most_fitted, [](const auto& one, const auto& other) {
      return (one.map.linear() - other.map.linear()).norm() < same_guess;
    });
    Maps near;
    for (const NearSymmetry& guess : rough) {
      context_.check();
      const Eigen::Isometry3d map = fitted(guess.map, many);
      near.push_back({map, deviation(map, many)});
    }
    std::stable_sort(near.begin(), near.end(), [](const auto& one, const auto& other) {
      return one.deviation < other.deviation;
    });
    for (const NearSymmetry& map : near) {
      if (map.deviation > tolerance || found_.maps.size() == most_near) break;
      if (!is_known(found_.maps, map.map.linear(), same_map)) found_.maps.push_back(map);
    }
  }

  // Of the landmarks before the last the one nearest to it.
  Index nearest_before(const std::vector<Index>& few) const {
    Index nearest = few.front();
    for (std::size_t k = 0; k + 1 < few.size(); ++k)
      if ((rows_.col(few[k]) - rows_.col(few.back())).norm() <
          (rows_.col(nearest) - rows_.col(few.back())).norm())
        nearest = few[k];
    return nearest;
  }

  const PointTree& tree_;
  const Context& context_;
  Columns rows_;  // the points from their centroid
  Eigen::VectorXd radii_;
  NearSymmetries found_;
};

}  // namespace

NearSymmetries near_symmetries(PointsView points, const PointTree& tree, double tolerance,
                               const Context& context) {
  return Search(points, tree, context).run(tolerance);
}

}  // namespace symsurf
