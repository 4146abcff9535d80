#pragma once

#include <Eigen/Dense>

namespace symsurf {

/// Climbs from `start` by BFGS with backtracking (Nocedal and Wright 2006, algorithms 6.1 and 3.1).
/// `function(x, &gradient)` must be smooth; stops after `steps` or when a step gains nothing.
template <int N, typename Function>
Eigen::Matrix<double, N, 1> maximise(const Function& function, Eigen::Matrix<double, N, 1> x,
                                     double first_step, int steps) {
  using Vector = Eigen::Matrix<double, N, 1>;
  using Square = Eigen::Matrix<double, N, N>;
  Vector gradient;
  double value = function(x, &gradient);
  if (gradient.isZero(0)) return x;
  Square inverse_hessian = Square::Identity() * (first_step / gradient.norm());

  for (int step = 0; step < steps; ++step) {
    Vector direction = inverse_hessian * gradient;
    double slope = direction.dot(gradient);
    if (!(slope > 0)) return x;
    double length = 1, next_value = value;
    Vector next, next_gradient;
    for (int halving = 0; halving < 6; ++halving, length /= 3) {
      next = x + length * direction;
      next_value = function(next, &next_gradient);
      if (next_value >= value + 1e-4 * length * slope) break;
    }
    if (!(next_value > value)) return x;
    const bool converged = next_value - value < 1e-7 * value;
    const Vector moved = next - x, turned = gradient - next_gradient;
    const double curvature = moved.dot(turned);
    if (curvature > 1e-12 * moved.norm() * turned.norm()) {
      const Square left = Square::Identity() - moved * turned.transpose() / curvature;
      inverse_hessian =
          left * inverse_hessian * left.transpose() + moved * moved.transpose() / curvature;
    }
    x = next;
    value = next_value;
    gradient = next_gradient;
    if (converged) return x;
  }
  return x;
}

}  // namespace symsurf
