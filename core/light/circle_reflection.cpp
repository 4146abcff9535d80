#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "reflection_search.h"

namespace symsurf {

std::vector<double> TurnPolynomial::zeros() const {
  const auto at = [&](double angle, double& slope) {
    const double c = std::cos(angle), s = std::sin(angle), cc = c * c - s * s, ss = 2 * s * c;
    slope = s1 * c - c1 * s + 2 * (s2 * cc - c2 * ss);
    return constant + c1 * c + s1 * s + c2 * cc + s2 * ss;
  };
  // The tangent of half the angle is infinite opposite to where it is reckoned from: of five
  // angles, one more than there are zeros, that farthest from one.
  double farthest = 0, from = 0, slope;
  for (int k = 0; k < 5; ++k) {
    const double angle = 2 * std::numbers::pi * k / 5 + 0.1, value = std::abs(at(angle, slope));
    if (!(value > farthest)) continue;
    farthest = value;
    from = angle + std::numbers::pi;
  }
  const double size =
      std::abs(constant) + std::abs(c1) + std::abs(s1) + std::abs(c2) + std::abs(s2);
  constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
  if (!(farthest > rounding * size)) return {};
  const std::complex<double> one = std::polar(1.0, -from) * std::complex(c1, s1),
                             two = std::polar(1.0, -2 * from) * std::complex(c2, s2);
  // Times (1 + t^2)^2.
  Eigen::Vector<double, 5> quartic;
  quartic << constant + two.real() + one.real(), 4 * two.imag() + 2 * one.imag(),
      2 * constant - 6 * two.real(), 2 * one.imag() - 4 * two.imag(),
      constant + two.real() - one.real();
  Matrix4 companion = Matrix4::Zero();
  companion.bottomLeftCorner<3, 3>().setIdentity();
  companion.col(3) = -quartic.head<4>() / quartic[4];
  std::vector<double> angles;
  for (const std::complex<double>& t : companion.eigenvalues()) {
    constexpr double real = 1e-6;  // of a double root's halves: the root of rounding
    if (std::abs(t.imag()) > real * (1 + std::abs(t))) continue;
    double angle = from + 2 * std::atan(t.real());
    for (int step = 0; step < 3; ++step) {
      const double move = at(angle, slope) / slope;
      if (std::abs(move) < real) angle -= move;
    }
    angles.push_back(angle);
  }
  return angles;
}

std::vector<Eigen::Vector2d> circle_reflection(const Eigen::Vector2d& source,
                                               const Eigen::Vector2d& eye) {
  using Complex = std::complex<double>;
  const Complex s(source.x(), source.y()), e(eye.x(), eye.y());
  const Complex p = s * e, q = s + e;
  const TurnPolynomial condition{0, -q.imag(), q.real(), p.imag(), -p.real()};
  std::vector<Eigen::Vector2d> found;
  for (const double angle : condition.zeros()) {
    const Complex z = std::polar(1.0, angle);
    const Complex product = (s / z - 1.0) * (e / z - 1.0);
    if (product.real() > 0) found.emplace_back(z.real(), z.imag());
  }
  return found;
}

}  // namespace symsurf
