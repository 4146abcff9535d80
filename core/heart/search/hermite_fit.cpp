#include "search/hermite_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/least_squares.h"
#include "base/math.h"
#include "base/vectorised.h"

namespace symsurf::perpendicular {

namespace {

using Row = Eigen::Matrix<double, 6, 1>;
using Normal = Eigen::Matrix<double, 6, 6>;

struct Equation {
  std::array<Row, 3> rows;
  Vector3 right;
  double weight = 0;
};

// What an equation adds to the normal equations at weight 1: the lower triangle, row by row, the
// right side, and a zero to fill the vector.
using Products = std::array<double, 28>;

Products products_of(const Equation& q) {
  Products products{};
  auto* next = products.data();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j, ++next)
      for (const Row& row : q.rows) *next += row[i] * row[j];
  for (int i = 0; i < 6; ++i, ++next)
    for (int a = 0; a < 3; ++a) *next += q.right[a] * q.rows[a][i];
  return products;
}

SYMSURF_VECTORISED void add_weighted(const double* products, const double* weights,
                                     std::size_t count, double* __restrict sum) {
  for (std::size_t e = 0; e < count; ++e)
    for (std::size_t k = 0; k < 28; ++k) sum[k] += weights[e] * products[28 * e + k];
}

}  // namespace

Matrix3 frame_of(const Vector3& normal) {
  Matrix3 frame;
  frame << orthogonal_to(normal).transpose(), normal.transpose();
  return frame;
}

double closeness(const Carried& c, double spacing) {
  constexpr double across_scale = 0.3, angle_scale = 0.3, exact_scale = 0.2, exact_share = 0.3;
  const double across = c.miss.dot(c.partner_normal) / (across_scale * spacing);
  const double angle = c.turned / angle_scale;
  const double exact = c.miss.squaredNorm() / (exact_scale * exact_scale * spacing * spacing);
  return (1 - exact_share) * std::exp(-(across * across + angle * angle) / 2) +
         exact_share * std::exp(-exact / 2);
}

bool fit_patch(const Vector3& centre, const Vector3& normal, const std::vector<Carried>& data,
               const FitWeights& weights, Patch& patch) {
  patch.centre = centre;
  patch.frame = frame_of(normal);
  const double unit = weights.radius;  // coordinates in units of the radius: well scaled

  static thread_local std::vector<Equation> equations;
  static thread_local std::vector<Products> products;
  static thread_local std::vector<double> trusted;
  equations.clear();
  products.clear();
  double total = 0;
  for (const Carried& c : data) {
    const Vector3 at = patch.frame * (c.foot - centre), n = patch.frame * c.normal;
    const double squared = at.squaredNorm() / (unit * unit);
    if (squared >= 1 || n.z() < 0.3) continue;
    Equation q;
    q.weight = c.weight * (1 - squared) * (1 - squared) * (1 - squared);
    total += q.weight;
    const double s = at.x() / unit, t = at.y() / unit;
    Row height, slope_s, slope_t;
    height << 1, s, t, s * s, s * t, t * t;
    slope_s << 0, 1, 0, 2 * s, t, 0;
    slope_t << 0, 0, 1, 0, s, 2 * t;
    // Where the mirror was: the patch's heights are measured from there.
    const double old_height = at.z() / unit;
    const double old_s = -n.x() / n.z(), old_t = -n.y() / n.z();
    const Vector3 miss = patch.frame * c.miss / unit;
    const Vector3 across = patch.frame * c.partner_normal;
    Matrix3 metric =
        weights.along * Matrix3::Identity() + (1 - weights.along) * across * across.transpose();
    const double d = c.distance / unit;
    // dx' = 2 (P - old) cos n + 2 d (grad P - old slope)
    std::array<Row, 3> shift;
    Vector3 right = miss / 2;
    for (int a = 0; a < 3; ++a) {
      shift[a] = n[a] * n.z() * height;
      right[a] += n[a] * n.z() * old_height;
    }
    shift[0] += d * slope_s;
    shift[1] += d * slope_t;
    right[0] += d * old_s;
    right[1] += d * old_t;
    for (int a = 0; a < 3; ++a)
      q.rows[a] = metric(a, 0) * shift[0] + metric(a, 1) * shift[1] + metric(a, 2) * shift[2];
    q.right = metric * right;
    equations.push_back(q);
    products.push_back(products_of(q));
  }
  if (equations.size() < 3) return false;

  Row solution = Row::Zero();
  static thread_local std::vector<double> misses, sorted;
  misses.resize(equations.size());
  for (int pass = 0; pass < weights.passes; ++pass) {
    double scale = 0;
    if (pass > 0) {
      for (std::size_t e = 0; e < equations.size(); ++e) {
        const Equation& q = equations[e];
        double squared = 0;
        for (int a = 0; a < 3; ++a) {
          const double r = q.rows[a].dot(solution) - q.right[a];
          squared += r * r;
        }
        misses[e] = 2 * std::sqrt(squared) * unit;
      }
      sorted = misses;
      const auto middle = sorted.begin() + sorted.size() / 2;
      std::nth_element(sorted.begin(), middle, sorted.end());
      scale = std::max(weights.robust_scale, 1.5 * *middle);
    }
    trusted.resize(equations.size());
    for (std::size_t e = 0; e < equations.size(); ++e)
      trusted[e] = equations[e].weight * (pass > 0 ? biweight(misses[e] / (4.7 * scale)) : 1);
    Products sum{};
    add_weighted(products.front().data(), trusted.data(), products.size(), sum.data());
    Normal matrix;
    const double* at = sum.data();
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j <= i; ++j, ++at) matrix(i, j) = matrix(j, i) = *at;
    const Row right = Row::Map(at);
    // Little data: prefer flat to wild.
    for (int k = 3; k < 6; ++k)
      matrix(k, k) += 1e-3 * total / static_cast<double>(equations.size());
    for (int k = 0; k < 3; ++k) matrix(k, k) += 1e-12 * total;
    const Row next = solved(matrix, right);
    if (!next.allFinite()) return false;
    solution = next;
  }
  patch.height = solution;
  patch.height[0] *= unit;
  patch.height.tail<3>() /= unit;
  patch.radius = weights.radius;
  return true;
}

bool patch_foot(const Patch& patch, const Vector3& x, Vector3& foot, Vector3& normal) {
  const Vector3 at = patch.frame * (x - patch.centre);
  const auto& h = patch.height;
  double s = 0, t = 0;
  Vector3 n;
  for (int step = 0; step < 8; ++step) {
    const double z = h[0] + h[1] * s + h[2] * t + h[3] * s * s + h[4] * s * t + h[5] * t * t;
    const double zs = h[1] + 2 * h[3] * s + h[4] * t, zt = h[2] + h[4] * s + 2 * h[5] * t;
    // Half the gradient of the squared distance, and its Gauss-Newton-plus-curvature matrix.
    const double up = z - at.z();
    const Eigen::Vector2d g(s - at.x() + up * zs, t - at.y() + up * zt);
    Eigen::Matrix2d m;
    m << 1 + zs * zs + 2 * up * h[3], zs * zt + up * h[4], zs * zt + up * h[4],
        1 + zt * zt + 2 * up * h[5];
    if (m.determinant() <= 0.01 || m.trace() <= 0) {
      m << 1 + zs * zs, zs * zt, zs * zt, 1 + zt * zt;
    }
    const Eigen::Vector2d move = m.inverse() * g;
    s -= move.x();
    t -= move.y();
    if (s * s + t * t > 4 * patch.radius * patch.radius) return false;
    if (move.norm() < 1e-6 * patch.radius) break;
  }
  const double z = h[0] + h[1] * s + h[2] * t + h[3] * s * s + h[4] * s * t + h[5] * t * t;
  n << -(h[1] + 2 * h[3] * s + h[4] * t), -(h[2] + h[4] * s + 2 * h[5] * t), 1;
  foot = patch.centre + patch.frame.transpose() * Vector3(s, t, z);
  normal = (patch.frame.transpose() * n).normalized();
  return true;
}

}  // namespace symsurf::perpendicular
