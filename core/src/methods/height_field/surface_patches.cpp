#include "methods/height_field/surface_patches.h"

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "base/math.h"
#include "base/quadratic_fit.h"

namespace symsurf {

namespace {

constexpr double least_cosine = 0.15;
constexpr int crossings = 3;  // Newton steps of a line onto a patch

}  // namespace

SurfacePatches::SurfacePatches(const SurfacePoints& cloud, Index neighbours, const Context& context)
    : patches_(cloud.size()) {
  std::vector<Neighbour> near;
  for (Index i = 0; i < cloud.size(); ++i) {
    context.check();
    Patch& patch = patches_[i];
    patch.normal = cloud.normal(i);
    const Eigen::Matrix<double, 3, 2> tangent = orthogonal_to(patch.normal);
    patch.first = tangent.col(0);
    patch.second = tangent.col(1);
    patch.centre = cloud.point(i);
    cloud.tree.nearest(patch.centre, neighbours, near);
    patch.reach = std::sqrt(near.back().squared_distance);
    QuadraticFit fit;
    for (const Neighbour& n : near) {
      const Vector3 d = (cloud.point(n.index) - patch.centre) / patch.reach;
      fit.add(patch.first.dot(d), patch.second.dot(d), patch.normal.dot(d),
              1 - 0.8 * d.squaredNorm());
    }
    const auto h = fit.coefficients(1e-3 * fit.weight());
    const double r = patch.reach;
    patch.height << h[0] * r, h[1], h[2], h[3] / r, h[4] / r, h[5] / r;
  }
}

double SurfacePatches::along(Index j, const Vector3& x, const Vector3& direction) const {
  const Patch& patch = patches_[j];
  const double da = patch.first.dot(direction), db = patch.second.dot(direction);
  const double dn = patch.normal.dot(direction);
  const Vector3 d = x - patch.centre;
  const double a0 = patch.first.dot(d), b0 = patch.second.dot(d), n0 = patch.normal.dot(d);
  const auto& h = patch.height;
  double t = 0;
  for (int step = 0; step < crossings; ++step) {
    double a = a0 + t * da, b = b0 + t * db;
    const double length = std::hypot(a, b);
    const double inside = length > patch.reach ? patch.reach / length : 1;
    const double tangent = h[1] * a + h[2] * b;
    const double bend = h[3] * a * a + h[4] * a * b + h[5] * b * b;
    const double height = h[0] + tangent + bend * (2 * inside - inside * inside);
    const double slope_a = h[1] + (2 * h[3] * a + h[4] * b) * inside;
    const double slope_b = h[2] + (h[4] * a + 2 * h[5] * b) * inside;
    const double rate = dn - slope_a * da - slope_b * db;
    if (std::abs(rate) < least_cosine) return std::numeric_limits<double>::quiet_NaN();
    t -= (n0 + t * dn - height) / rate;
  }
  return t;
}

}  // namespace symsurf
