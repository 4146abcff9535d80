#include "optics/circle_reflection.h"

#include <complex>

#include "optics/real_zeros.h"

namespace symsurf {

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
