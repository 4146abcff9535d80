#include "cloud/exact_isometries.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "cloud/cloud.h"

namespace symsurf {

namespace {

constexpr double single_precision = 2e-6;         // of the set's diameter: from an image to a point
constexpr double guessing = 25;                   // as far off, where two points define the map
constexpr double same_map = 50;                   // between matrices
constexpr double guessing_far = 3, same_far = 8;  // the same, of a tolerance
constexpr double least_radius = 0.3;              // of the largest, of points that define a map
constexpr double least_sine = 0.3;                // of the angle between two of them
constexpr Index most_bases = 4'000'000;           // pairs that are tried for the base
constexpr std::size_t farthest = 10'000;          // points that the base is chosen of

// How often a file repeats a point must not move it.
Vector3 centre_of(PointsView points, const PointTree& tree) {
  Vector3 sum = Vector3::Zero();
  double count = 0;
  for (std::size_t p = 0; p < tree.order().size(); ++p) {
    const Vector3 x = points[tree.order()[p]];
    if (p > 0 && x == points[tree.order()[p - 1]]) continue;
    sum += x;
    count += 1;
  }
  return sum / count;
}

class Search {
 public:
  Search(PointsView points, const PointTree& tree, Index checked, double tolerance)
      : all_(points),
        tree_(tree),
        centre_(tree.has_copies() ? centre_of(points, tree)
                                  : Vector3(points.matrix().colwise().mean())),
        points_(farthest_of(points)),
        radii_(points_.colwise().norm()),
        diameter_(2 * radii_.maxCoeff()),
        exactly_(std::max(single_precision, tolerance / diameter_)),
        guessed_(std::max(guessing * single_precision, guessing_far * tolerance / diameter_)),
        same_(std::max(same_map * single_precision, same_far * tolerance / diameter_)),
        whole_from_(static_cast<Index>(radii_.size()) == points.size()
                        ? 0
                        : radii_.minCoeff() + guessed_ * diameter_),
        checked_(3, std::min(checked, points.size())) {
    for (Index k = 0; k < checked_.cols(); ++k)
      checked_.col(k) = points[k * points.size() / checked_.cols()] - centre_;
  }

  ExactIsometries run(std::size_t most, const Context& context) {
    ExactIsometries found{{Matrix3::Identity()}, {}, centre_};
    std::vector<Matrix3> fitted = found.maps;
    const auto [a, b] = base_points();
    if (a < 0 || b < 0) return found;
    const std::vector<Index> as_a = as_far_as(a), as_b = as_far_as(b);
    const auto pairs = static_cast<Index>(as_a.size() * as_b.size());
    const auto stride = static_cast<std::size_t>(std::max<Index>(1, pairs / most_bases));
    const double apart = (points_.col(a) - points_.col(b)).norm();
    const Matrix3 base = basis_of(points_.col(a), points_.col(b));
    for (std::size_t i = 0; i < as_a.size(); i += stride) {
      context.check();
      for (const Index j : as_b) {
        const double distance = (points_.col(as_a[i]) - points_.col(j)).norm();
        if (std::abs(distance - apart) > guessed_ * diameter_) continue;
        const Matrix3 onto = basis_of(points_.col(as_a[i]), points_.col(j));
        for (const double side : {1.0, -1.0}) {
          Matrix3 map = onto * Vector3(1, 1, side).asDiagonal() * base.transpose();
          // In crowds of points any pair stands for the same map.
          if (is_known(fitted, map) || is_known(found.maps, map) || !fit(map, guessed_)) continue;
          fitted.push_back(map);
          if (fit(map, exactly_) && !is_known(found.maps, map)) add(map, most, found);
        }
        if (found.maps.size() >= most) return found;
      }
    }
    return found;
  }

 private:
  using Columns = Eigen::Matrix<double, 3, Eigen::Dynamic>;

  // From the centre.
  Columns farthest_of(PointsView points) const {
    std::vector<Vector3> found;
    double least = 0;
    const auto farther = [](const Vector3& a, const Vector3& b) {
      return a.squaredNorm() > b.squaredNorm();
    };
    const auto keep_farthest = [&] {
      if (found.size() <= farthest) return;
      std::nth_element(found.begin(), found.begin() + farthest, found.end(), farther);
      least = found[farthest].squaredNorm();
      found.resize(farthest);
    };
    for (Index i = 0; i < points.size(); ++i) {
      const Vector3 x = points[i] - centre_;
      if (x.squaredNorm() < least) continue;
      found.push_back(x);
      if (found.size() >= 4 * farthest) keep_farthest();
    }
    keep_farthest();
    return rows_of(found).transpose();
  }

  // Two points in directions far from parallel, of radii that few others have: these are all that
  // the points can be mapped to. -1: there are none.
  std::pair<Index, Index> base_points() const {
    std::vector<double> sorted(radii_.begin(), radii_.end());
    std::sort(sorted.begin(), sorted.end());
    std::vector<Index> counts;
    for (const double radius : radii_)
      counts.push_back(
          std::upper_bound(sorted.begin(), sorted.end(), radius + exactly_ * diameter_) -
          std::lower_bound(sorted.begin(), sorted.end(), radius - exactly_ * diameter_));
    const auto rarest = [&](const auto& allowed) {
      Index best = -1;
      for (Index i = 0; i < radii_.size(); ++i)
        if (2 * radii_[i] >= least_radius * diameter_ && radii_[i] >= whole_from_ && allowed(i) &&
            (best < 0 || counts[i] < counts[best] ||
             (counts[i] == counts[best] && radii_[i] > radii_[best])))
          best = i;
      return best;
    };
    const Index a = rarest([](Index) { return true; });
    if (a < 0) return {-1, -1};
    const auto across = [&](Index i) { return points_.col(a).cross(points_.col(i)).norm(); };
    const Index b = rarest([&](Index i) { return across(i) > least_sine * radii_[a] * radii_[i]; });
    if (b >= 0) return {a, b};
    Index widest = 0;  // of a slender set
    for (Index i = 0; i < radii_.size(); ++i)
      if (across(i) > across(widest)) widest = i;
    return {a, across(widest) > exactly_ * radii_[a] * diameter_ ? widest : -1};
  }

  std::vector<Index> as_far_as(Index point) const {
    std::vector<Index> alike;
    for (Index i = 0; i < radii_.size(); ++i)
      if (std::abs(radii_[i] - radii_[point]) <= guessed_ * diameter_) alike.push_back(i);
    return alike;
  }

  // The isometry nearest to where a map sends the points, if all come near to points of the set.
  bool fit(Matrix3& map, double reach) {
    const double limit = reach * reach * diameter_ * diameter_;
    const auto partner_of = [&](Index i) {
      return tree_.nearest(centre_ + map * checked_.col(i), limit).index;
    };
    if (partner_of(hardest_) < 0) return false;
    Matrix3 products = Matrix3::Zero();
    for (Index i = 0; i < checked_.cols(); ++i) {
      const Index partner = partner_of(i);
      if (partner < 0) {
        hardest_ = i;
        return false;
      }
      products += (all_[partner] - centre_) * checked_.col(i).transpose();
    }
    map = nearest_orthogonal(products, map.determinant());
    return true;
  }

  // With all products: each map found is multiplied by each generator.
  void add(const Matrix3& generator, std::size_t most, ExactIsometries& found) const {
    found.generators.push_back(generator);
    for (std::size_t i = 0; i < found.maps.size(); ++i)
      for (const Matrix3& factor : found.generators) {
        if (found.maps.size() >= most) return;
        const Matrix3 product = factor * found.maps[i];
        if (!is_known(found.maps, product) && keeps_some(product)) found.maps.push_back(product);
      }
  }

  // Rounding adds up in products, of slender sets about their axes.
  bool keeps_some(const Matrix3& map) const {
    constexpr Index enough = 200;
    const double limit = exactly_ * exactly_ * diameter_ * diameter_;
    for (Index i = 0; i < checked_.cols(); i += std::max<Index>(1, checked_.cols() / enough))
      if (tree_.nearest(centre_ + map * checked_.col(i), limit).index < 0) return false;
    return true;
  }

  bool is_known(const std::vector<Matrix3>& maps, const Matrix3& map) const {
    return std::any_of(maps.begin(), maps.end(),
                       [&](const Matrix3& other) { return (other - map).norm() < same_; });
  }

  PointsView all_;
  const PointTree& tree_;
  Vector3 centre_;
  Columns points_;  // that are farthest from it, from it
  Eigen::VectorXd radii_;
  double diameter_;
  double exactly_, guessed_;  // of it
  double same_;               // between matrices
  double whole_from_;         // radius from which on these are all points
  Columns checked_;           // from the centre
  Index hardest_ = 0;         // that the last map took nowhere: others may miss there, too
};

// The normal of a reflection; none of other maps.
std::optional<Vector3> reflected_normal(const Matrix3& map) {
  constexpr double least_angle = 1e-3;  // radians
  if (map.determinant() > 0 || map.trace() < 0 || (map - map.transpose()).norm() > least_angle)
    return {};
  return Vector3(eigen_of(Matrix3(map + map.transpose())).vectors.col(0));
}

}  // namespace

ExactIsometries exact_isometries(PointsView points, const PointTree& tree, const Context& context,
                                 std::size_t most, Index checked, double tolerance) {
  return Search(points, tree, checked, tolerance).run(most, context);
}

std::vector<Matrix3> polished(const std::vector<Matrix3>& maps) {
  constexpr int rounds = 4;
  constexpr double apart = 0.1;       // of matrices; a turn by 3 degrees is 0.07 off
  constexpr std::size_t enough = 60;  // quotients a map is the mean of
  const std::size_t count = maps.size(), factors = std::min(count, enough);
  std::vector<std::size_t> product;
  for (const Matrix3& map : maps)
    for (std::size_t h = 0; h < factors; ++h) {
      const Matrix3 wanted = map * maps[h];
      std::size_t best = 0;
      double least = apart * apart;
      for (std::size_t k = 0; k < count; ++k)
        if (const double off = (maps[k] - wanted).squaredNorm(); off < least)
          std::tie(best, least) = std::pair(k, off);
      if (least == apart * apart) return {};
      product.push_back(best);
    }
  std::vector<Matrix3> group = maps;
  for (int round = 0; round < rounds; ++round) {
    const std::vector<Matrix3> before = group;
    for (std::size_t g = 0; g < count; ++g) {
      Matrix3 sum = Matrix3::Zero();
      for (std::size_t h = 0; h < factors; ++h)
        sum += before[product[g * factors + h]] * before[h].transpose();
      group[g] = nearest_orthogonal(sum, maps[g].determinant());
    }
  }
  group.front().setIdentity();
  return group;
}

std::vector<Plane> exact_planes(const Cloud& cloud, const Context& context) {
  constexpr Index checked = 1000;
  constexpr std::size_t most = 2000;  // points near a line turn about it by any angle
  const ExactIsometries found =
      exact_isometries(cloud.points, cloud.tree(context), context, most, checked);
  std::vector<Plane> planes;
  for (const Matrix3& map : found.maps) {
    const std::optional<Vector3> normal = reflected_normal(map);
    if (!normal) continue;
    const Plane plane =
        in_input_units(UnitPlane{*normal, -normal->dot(found.centre)}, PrincipalFrame());
    // A flat cloud's own plane moves nothing.
    Index i = 0;
    while (i < cloud.points.size() &&
           std::abs(plane.signed_distance(cloud.points[i])) <= single_rounding * cloud.frame.size)
      ++i;
    if (i < cloud.points.size()) planes.push_back(plane);
  }
  longest_first(planes, cloud.frame);
  return planes;
}

void longest_first(std::vector<Plane>& planes, const PrincipalFrame& frame) {
  const auto variance = [&](const Plane& plane) {
    const Vector3 normal = frame.axes.transpose() * plane.normal();
    return std::round(frame.variance.dot(normal.cwiseAbs2()) /
                      (double_rounding * frame.variance.maxCoeff()));
  };
  std::stable_sort(planes.begin(), planes.end(),
                   [&](const Plane& a, const Plane& b) { return variance(a) > variance(b); });
}

Matrix3 basis_of(const Vector3& one, const Vector3& other) {
  Matrix3 axes;
  axes.col(0) = one.normalized();
  axes.col(2) = one.cross(other).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

}  // namespace symsurf
