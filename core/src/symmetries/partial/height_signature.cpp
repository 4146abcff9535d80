#include "symmetries/partial/height_signature.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/eigenvectors.h"
#include "base/least_squares.h"
#include "base/math.h"

namespace symsurf {

namespace {

constexpr int terms = 15;
using Row = Eigen::Vector<double, terms>;

// Zernike polynomials of root mean square 1 over the unit disc: of order 0, then pairs of a cosine
// and a sine, as HeightSignature::orders; last the tilt.
Row zernike(double u, double v) {
  const std::complex<double> w1(u, v), w2 = w1 * w1, w3 = w2 * w1, w4 = w2 * w2;
  const double r2 = u * u + v * v;
  const double third = std::sqrt(8.0), second = std::sqrt(6.0), fourth = std::sqrt(10.0);
  const std::complex<double> z31 = third * (3 * r2 - 2) * w1, z22 = second * w2,
                             z42 = fourth * (4 * r2 - 3) * w2, z33 = third * w3, z44 = fourth * w4;
  Row row;
  row << 1, std::sqrt(3.0) * (2 * r2 - 1), std::sqrt(5.0) * (6 * r2 * r2 - 6 * r2 + 1), z31.real(),
      z31.imag(), z22.real(), z22.imag(), z42.real(), z42.imag(), z33.real(), z33.imag(),
      z44.real(), z44.imag(), 2 * u, 2 * v;
  return row;
}

Matrix3 frame_along(const Vector3& normal) {
  Matrix3 frame;
  frame.col(0) = orthogonal_to(normal).col(0);
  frame.col(1) = normal.cross(frame.col(0));
  frame.col(2) = normal;
  return frame;
}

}  // namespace

Eigen::Vector<double, HeightSignature::length> HeightSignature::invariants() const {
  // The phase between the two waves of order 2, which a turn leaves and a reflection keeps in its
  // cosine.
  const double both = std::abs(waves[1]) + std::abs(waves[2]);
  const double along = both > 0 ? (waves[1] * std::conj(waves[2])).real() / both : 0;
  Eigen::Vector<double, length> all;
  all << even[0], even[1], std::abs(waves[0]), std::abs(waves[1]), std::abs(waves[2]),
      std::abs(waves[3]), std::abs(waves[4]), along;
  return all;
}

double HeightSignature::waviness() const {
  double squared = 0;
  for (const auto& wave : waves) squared += std::norm(wave);
  return std::sqrt(squared);
}

HeightSignature HeightSignature::from_behind() const {
  HeightSignature other = *this;
  other.frame.rightCols<2>() *= -1;  // a reflection of the disc, and of heights
  for (double& x : other.even) x = -x;
  for (auto& wave : other.waves) wave = -std::conj(wave);
  return other;
}

DiscSamples::DiscSamples(const SurfacePoints& surface, double radius, const Context& context)
    : radius_(radius), points_(thinned(surface, radius)), tree_(points_, context) {}

Points DiscSamples::thinned(const SurfacePoints& surface, double radius) {
  constexpr Index enough = 150, most_looked_at = 64;  // samples of a disc, discs
  const std::vector<std::int32_t>& order = surface.tree.order();
  const Index size = surface.size(), looked_at = std::min(size, most_looked_at);
  Index held = 0;
  for (Index k = 0; k < looked_at; ++k)
    surface.tree.within(surface.point(order[k * size / looked_at]), radius,
                        [&](Index, double) { ++held; });
  const Index stride = std::max<Index>(1, held / (enough * std::max<Index>(1, looked_at)));
  if (stride == 1) return surface.points;
  Points chosen((size + stride - 1) / stride, 3);
  for (Index k = 0; k < chosen.rows(); ++k) chosen.row(k) = surface.points.row(order[k * stride]);
  return chosen;
}

std::optional<HeightSignature> DiscSamples::about(const Vector3& x) const {
  constexpr std::size_t enough = 20;
  const double radius = radius_;
  std::vector<Neighbour> around;
  tree_.within(x, radius, [&](Index j, double squared) { around.push_back({j, squared}); });
  if (around.size() < enough) return {};
  std::sort(around.begin(), around.end());
  Vector3 mean = Vector3::Zero();
  double weights = 0;
  Matrix3 scatter = Matrix3::Zero();
  for (const Neighbour& n : around) {
    const double weight = 1 - n.squared_distance / (radius * radius);
    const Vector3 d = (point(n.index) - x) / radius;
    mean += weight * d;
    scatter += weight * d * d.transpose();
    weights += weight;
  }
  mean /= weights;
  const LeastEigen least = least_eigen_of(scatter / weights - mean * mean.transpose());
  if (!(least.next > 1e-6 * least.greatest)) return {};
  Vector3 normal = least.vector;

  HeightSignature signature;
  signature.radius = radius;
  for (int pass = 0; pass < 2; ++pass) {
    signature.frame = frame_along(normal);
    Eigen::Matrix<double, terms, terms> products = Eigen::Matrix<double, terms, terms>::Zero();
    Row right = Row::Zero();
    for (const Neighbour& n : around) {
      const Vector3 at = signature.frame.transpose() * (point(n.index) - x) / radius;
      const Row row = zernike(at.x(), at.y());
      products.selfadjointView<Eigen::Lower>().rankUpdate(row);
      right += at.z() * row;
    }
    // Where a disc is cut by a rim, what it leaves open is drawn to 0.
    constexpr double ridge = 0.02;
    products.diagonal().array() += ridge * static_cast<double>(around.size());
    const Row h = solved(products, right);
    signature.even = {h[1], h[2]};
    for (int w = 0; w < HeightSignature::turning; ++w)
      signature.waves[w] = {h[3 + 2 * w], h[4 + 2 * w]};
    const double height = h[0] - std::sqrt(3.0) * h[1] + std::sqrt(5.0) * h[2];
    signature.origin = x + radius * height * normal;
    const Vector3 slope = -2 * (h[13] * signature.frame.col(0) + h[14] * signature.frame.col(1));
    normal = (normal + slope).normalized();
  }
  return signature.even[0] < 0 ? signature.from_behind() : signature;
}

std::optional<DiscMatch> best_match(const HeightSignature& from, const HeightSignature& onto,
                                    bool reflected) {
  std::array<std::complex<double>, 5> by_order{};
  double squares = 0, mean = 0;
  for (int w = 0; w < HeightSignature::turning; ++w) {
    const std::complex<double> a = reflected ? std::conj(from.waves[w]) : from.waves[w];
    by_order[HeightSignature::orders[w]] += onto.waves[w] * std::conj(a);
    squares += std::norm(from.waves[w]) + std::norm(onto.waves[w]);
  }
  for (int e = 0; e < 2; ++e) {
    const double gap = from.even[e] - onto.even[e];
    mean += gap * gap;
  }
  if (!(squares > 0)) return {};
  const auto overlap = [&](double angle) {
    double sum = 0;
    for (int m = 1; m <= 4; ++m)
      sum += by_order[m].real() * std::cos(m * angle) + by_order[m].imag() * std::sin(m * angle);
    return sum;
  };
  constexpr int steps = 36;
  std::array<double, steps> values;
  constexpr double step = 2 * std::numbers::pi / steps;
  for (int k = 0; k < steps; ++k) values[k] = overlap(k * step);
  const auto greatest = std::max_element(values.begin(), values.end());
  const auto k = static_cast<int>(greatest - values.begin());
  const double before = values[(k + steps - 1) % steps], after = values[(k + 1) % steps];
  const double bend = before - 2 * *greatest + after;
  if (!(bend < 0)) return {};
  const double angle = (k + (before - after) / (2 * bend)) * step;
  const double left = std::max(0.0, squares - 2 * overlap(angle)) + mean;
  return DiscMatch{angle, std::sqrt(2 * left / squares)};
}

Eigen::Affine3d laid_onto(const HeightSignature& from, const HeightSignature& onto, bool reflected,
                          double angle) {
  Matrix3 turn = Eigen::AngleAxisd(angle, Vector3::UnitZ()).toRotationMatrix();
  if (reflected) turn.col(1) *= -1;
  Eigen::Affine3d map = Eigen::Affine3d::Identity();
  map.linear() = onto.radius / from.radius * (onto.frame * turn * from.frame.transpose());
  map.translation() = onto.origin - map.linear() * from.origin;
  return map;
}

}  // namespace symsurf
