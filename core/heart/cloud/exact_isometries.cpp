#include "cloud/exact_isometries.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "cloud/cloud.h"

namespace symsurf {

namespace {

constexpr double least_angle = 1e-3;   // between the directions of two points, radians
constexpr std::size_t farthest = 512;  // points that are looked at

// Points that lie equally far from the centroid.
using Shell = std::vector<Vector3>;

// The outermost shells, each whole.
std::vector<Shell> outer_shells(const Cloud& cloud) {
  const auto farther = [](const Vector3& a, const Vector3& b) {
    return a.squaredNorm() > b.squaredNorm();
  };
  std::vector<Vector3> points;
  double least = 0;
  const auto keep_farthest = [&] {
    if (points.size() <= farthest) return;
    std::nth_element(points.begin(), points.begin() + farthest, points.end(), farther);
    points.resize(farthest);
    least = std::min_element(points.begin(), points.end(), [&](const auto& a, const auto& b) {
              return farther(b, a);
            })->squaredNorm();
  };
  for (Index i = 0; i < cloud.points.size(); ++i) {
    const Vector3 x = cloud.frame.to_frame(cloud.points[i]);
    if (x.squaredNorm() < least) continue;
    points.push_back(x);
    if (points.size() >= 4 * farthest) keep_farthest();
  }
  keep_farthest();
  const bool is_all = static_cast<Index>(points.size()) == cloud.points.size();
  std::stable_sort(points.begin(), points.end(), farther);
  if (points.size() > farthest) points.resize(farthest);

  std::vector<Shell> shells;
  double radius = 0;
  for (const Vector3& x : points) {
    if (shells.empty() || radius - x.norm() > single_rounding) shells.emplace_back();
    radius = x.norm();
    if (radius > single_rounding) shells.back().push_back(x);
  }
  if (!is_all && !shells.empty()) shells.pop_back();  // it may go on farther in
  return shells;
}

// Unit normals of the planes through the centroid that may map the shells onto themselves.
std::vector<Vector3> possible_normals(std::vector<Shell> shells) {
  std::vector<Vector3> normals;
  std::erase_if(shells, [](const Shell& shell) { return shell.empty(); });
  std::stable_sort(shells.begin(), shells.end(),
                   [](const Shell& a, const Shell& b) { return a.size() < b.size(); });
  if (shells.empty()) return normals;
  const auto add_bisectors = [&](const Shell& shell, const Vector3& a) {
    for (const Vector3& other : shell)
      if ((other - a).norm() > single_rounding) normals.push_back((other - a).normalized());
  };
  const Vector3& a = shells.front().front();
  add_bisectors(shells.front(), a);
  for (const Shell& shell : shells)
    for (const Vector3& b : shell) {
      const Vector3 across = a.normalized().cross(b.normalized());
      if (across.norm() < least_angle) continue;
      add_bisectors(shell, b);
      normals.push_back(across.normalized());
      return normals;
    }
  return normals;
}

// Drops the planes that move some of the positions elsewhere than onto points.
void keep_exact(std::vector<UnitPlane>& planes, const Points& positions, const Cloud& cloud,
                const NearestPoints& points) {
  std::vector<Vector3> images;
  for (const UnitPlane& plane : planes)
    for (Index i = 0; i < positions.rows(); ++i)
      images.push_back(cloud.frame.from_frame(plane.reflect(positions.row(i).transpose())));
  const std::vector<Vector3> partners = points.nearest(images, single_rounding * cloud.frame.size);
  std::size_t k = 0;
  std::erase_if(planes, [&](const UnitPlane&) {
    bool exact = true;
    for (Index i = 0; i < positions.rows(); ++i) exact = partners[k++].allFinite() && exact;
    return !exact;
  });
}

}  // namespace

std::vector<UnitPlane> exact_planes(const Cloud& cloud, const NearestPoints& points,
                                    const Surfels& samples) {
  std::vector<UnitPlane> planes;
  for (const Vector3& normal : possible_normals(outer_shells(cloud))) planes.push_back({normal, 0});
  for (const Index count : {Index{4}, Index{64}, samples.size()}) {
    Points positions(std::min(count, samples.size()), 3);
    for (Index k = 0; k < positions.rows(); ++k)
      positions.row(k) = samples[k * samples.size() / positions.rows()].sampled.transpose();
    keep_exact(planes, positions, cloud, points);
  }
  suppress_non_maxima(planes, planes.size(), [](const UnitPlane& plane, const UnitPlane& other) {
    return plane.normal.cross(other.normal).norm() < least_angle;
  });
  // A flat cloud's own plane moves nothing.
  std::erase_if(planes, [&](const UnitPlane& plane) {
    for (Index k = 0; k < samples.size(); ++k)
      if (std::abs(plane.distance(samples[k].sampled)) > single_rounding) return false;
    return true;
  });
  return planes;
}

// How often a file repeats a point must not move the centroid.
std::vector<Plane> exact_planes(PointsView points, const Context& context) {
  const Points distinct = chosen_rows(points, distinct_points(points, context).first);
  const Cloud cloud = checked_cloud(distinct, {}, 1, context);
  const PointTree tree(distinct, context);
  std::vector<Plane> planes;
  for (const UnitPlane& plane : exact_planes(cloud, NearestPoints(distinct, tree, context),
                                             Surfels(cloud, distinct.rows(), context)))
    planes.push_back(in_input_units(plane, cloud.frame));
  return planes;
}

namespace {

// Of the set's diameter: from an image to a point, single precision; the same under an isometry
// that two points define.
constexpr double exactly = 2e-6, guessed = 5e-5;
constexpr double same_map = 1e-4;        // between matrices
constexpr double least_radius = 0.3;     // of the largest, of points that define a map
constexpr double least_sine = 0.3;       // of the angle between two of them
constexpr Index most_bases = 4'000'000;  // pairs that are tried for the base

class Search {
 public:
  Search(PointsView points, const PointTree& tree)
      : tree_(tree),
        centre_(points.matrix().colwise().mean().transpose()),
        points_((points.matrix().rowwise() - centre_.transpose()).transpose()),
        radii_(points_.colwise().norm()),
        diameter_(2 * radii_.maxCoeff()) {}

  ExactIsometries run(std::size_t most, const Context& context) {
    ExactIsometries found{{Matrix3::Identity()}, {}};
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
        if (std::abs(distance - apart) > guessed * diameter_) continue;
        const Matrix3 onto = basis_of(points_.col(as_a[i]), points_.col(j));
        for (const double side : {1.0, -1.0}) {
          Matrix3 map = onto * Vector3(1, 1, side).asDiagonal() * base.transpose();
          // In crowds of points any pair stands for the same map.
          if (is_known(fitted, map) || is_known(found.maps, map) || !fit(map, guessed)) continue;
          fitted.push_back(map);
          if (fit(map, exactly) && !is_known(found.maps, map)) add(map, most, found);
        }
        if (found.maps.size() >= most) return found;
      }
    }
    return found;
  }

 private:
  // Two points in directions far from parallel, of radii that few others have: these are all that
  // the points can be mapped to. -1: there are none.
  std::pair<Index, Index> base_points() const {
    std::vector<double> sorted(radii_.begin(), radii_.end());
    std::sort(sorted.begin(), sorted.end());
    std::vector<Index> counts;
    for (const double radius : radii_)
      counts.push_back(
          std::upper_bound(sorted.begin(), sorted.end(), radius + exactly * diameter_) -
          std::lower_bound(sorted.begin(), sorted.end(), radius - exactly * diameter_));
    const auto rarest = [&](const auto& allowed) {
      Index best = -1;
      for (Index i = 0; i < radii_.size(); ++i)
        if (2 * radii_[i] >= least_radius * diameter_ && allowed(i) &&
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
    return {a, across(widest) > exactly * radii_[a] * diameter_ ? widest : -1};
  }

  std::vector<Index> as_far_as(Index point) const {
    std::vector<Index> alike;
    for (Index i = 0; i < radii_.size(); ++i)
      if (std::abs(radii_[i] - radii_[point]) <= guessed * diameter_) alike.push_back(i);
    return alike;
  }

  // The isometry nearest to where a map sends the points, if all come near to points of the set.
  bool fit(Matrix3& map, double reach) {
    const double limit = reach * reach * diameter_ * diameter_;
    const auto partner_of = [&](Index i) {
      return tree_.nearest(centre_ + map * points_.col(i), limit).index;
    };
    if (partner_of(hardest_) < 0) return false;
    Matrix3 products = Matrix3::Zero();
    for (Index i = 0; i < points_.cols(); ++i) {
      const Index partner = partner_of(i);
      if (partner < 0) {
        hardest_ = i;
        return false;
      }
      products += points_.col(partner) * points_.col(i).transpose();
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
    const double limit = exactly * exactly * diameter_ * diameter_;
    for (Index i = 0; i < points_.cols(); i += std::max<Index>(1, points_.cols() / enough))
      if (tree_.nearest(centre_ + map * points_.col(i), limit).index < 0) return false;
    return true;
  }

  static bool is_known(const std::vector<Matrix3>& maps, const Matrix3& map) {
    return std::any_of(maps.begin(), maps.end(),
                       [&](const Matrix3& other) { return (other - map).norm() < same_map; });
  }

  const PointTree& tree_;
  Vector3 centre_;
  Eigen::Matrix<double, 3, Eigen::Dynamic> points_;  // from it
  Eigen::VectorXd radii_;
  double diameter_;
  Index hardest_ = 0;  // that the last map took nowhere: others may miss there, too
};

}  // namespace

ExactIsometries exact_isometries(PointsView points, const PointTree& tree, const Context& context,
                                 std::size_t most) {
  return Search(points, tree).run(most, context);
}

Matrix3 basis_of(const Vector3& one, const Vector3& other) {
  Matrix3 axes;
  axes.col(0) = one.normalized();
  axes.col(2) = one.cross(other).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

}  // namespace symsurf
