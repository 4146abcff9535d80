#include "partial/height_signature.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_set>

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

HeightSignature HeightSignature::from_behind() const {
  HeightSignature other = *this;
  other.frame.rightCols<2>() *= -1;  // a reflection of the disc, and of heights
  for (double& x : other.even) x = -x;
  for (auto& wave : other.waves) wave = -std::conj(wave);
  return other;
}

SurfaceDiscs::SurfaceDiscs(const SurfacePoints& surface, double radius)
    : surface_(surface), radius_(radius) {}

std::vector<SurfaceDiscs::Oriented> SurfaceDiscs::connected(Index i) const {
  constexpr double facing_away = -0.3;  // cosine: the sides of a square bar stand upright
  const Vector3 x = surface_.point(i), own = surface_.normal(i);
  std::unordered_set<Index> seen{i};
  std::vector<Oriented> reached{{i, own}};
  for (std::size_t k = 0; k < reached.size(); ++k)
    for (int n = 0; n < SurfacePoints::ring; ++n) {
      const Index other = surface_.neighbours(reached[k].point, n);
      if (!((surface_.point(other) - x).squaredNorm() < radius_ * radius_)) continue;
      if (!seen.insert(other).second) continue;
      Vector3 normal = surface_.normal(other);
      if (normal.dot(reached[k].normal) < 0) normal = -normal;
      if (normal.dot(own) > facing_away) reached.push_back({other, normal});
    }
  return reached;
}

std::optional<HeightSignature> SurfaceDiscs::about(Index i) const {
  constexpr std::size_t enough = 20, most = 150;
  const double radius = radius_;
  const Vector3 x = surface_.point(i);
  const std::vector<Oriented> all = connected(i);
  if (all.size() < enough) return {};
  std::vector<Oriented> around;
  for (std::size_t k = 0; k < all.size(); k += 1 + all.size() / most) around.push_back(all[k]);
  Vector3 normal = Vector3::Zero();
  for (const Oriented& sample : around) normal += sample.normal;
  if (!(normal.norm() > 0)) return {};
  normal.normalize();

  HeightSignature signature;
  signature.radius = radius;
  for (int pass = 0; pass < 2; ++pass) {
    signature.frame = frame_along(normal);
    Eigen::Matrix<double, terms, terms> products = Eigen::Matrix<double, terms, terms>::Zero();
    Row right = Row::Zero();
    for (const Oriented& sample : around) {
      const Vector3 at = signature.frame.transpose() * (surface_.point(sample.point) - x) / radius;
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

std::vector<DiscMatch> matches(const HeightSignature& from, const HeightSignature& onto,
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
  constexpr int steps = 36;
  constexpr double step = 2 * std::numbers::pi / steps;
  static const auto turned = [] {
    std::array<std::complex<double>, steps> unit;
    for (int k = 0; k < steps; ++k) unit[k] = std::polar(1.0, -k * step);
    return unit;
  }();
  std::array<double, steps> overlaps{};
  for (int k = 0; k < steps; ++k)
    for (int m = 1; m <= 4; ++m) overlaps[k] += (by_order[m] * turned[m * k % steps]).real();
  std::vector<DiscMatch> found;
  for (int k = 0; k < steps; ++k) {
    const double before = overlaps[(k + steps - 1) % steps], after = overlaps[(k + 1) % steps];
    const double bend = before - 2 * overlaps[k] + after;
    if (!(overlaps[k] >= before && overlaps[k] > after && bend < 0)) continue;
    const double left = std::max(0.0, squares - 2 * overlaps[k]) + mean;
    found.push_back({(k + (before - after) / (2 * bend)) * step, std::sqrt(2 * left / squares)});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const DiscMatch& a, const DiscMatch& b) { return a.residual < b.residual; });
  return found;
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
