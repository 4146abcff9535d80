#include "score/ball.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace symsurf {

namespace {

constexpr double penalty = 1.2;  // of the worst miss
constexpr double least = 3;      // points that span a plane
// Shares of the points: fewer on one side are a rim, as many are there by chance.
constexpr double strip = 0.5, whole = 0.7;

double squared(double x) { return x * x; }

}  // namespace

Ball::Ball(const ThinnedHalf& set, const Vector3& centre, double radius) {
  double weights = 0, squares = 0;
  Matrix3 products = Matrix3::Zero();  // its lower triangle
  const double per_squared = 1 / squared(radius);
  set.tree.within(centre, radius, [&](Index i, double squared_distance) {
    const double weight = 1 - squared_distance * per_squared;
    const Vector3 offset = set.points.row(i).transpose() - centre, weighted = weight * offset;
    ++count;
    weights += weight;
    squares += squared(weight);
    mean += weighted;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column <= row; ++column)
        products(row, column) += weighted[row] * offset[column];
  });
  if (!(weights > 0)) return;
  effective = squared(weights) / squares;
  mean /= weights;
  Matrix3 covariance = products.selfadjointView<Eigen::Lower>();
  covariance = covariance / weights - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Matrix3> solver;
  solver.computeDirect(covariance);
  variances = solver.eigenvalues().cwiseMax(0);
  axes = solver.eigenvectors();
  // Of points that fill the ball, weighted like these.
  const double filled = squared(radius) / 7;
  constexpr double thin = 0.25, thick = 0.5;
  thinness = ((thick - variances.array() / filled) / (thick - thin)).cwiseMax(0).cwiseMin(1);
  const bool is_line = variances[1] <= 0.02 * variances[2];
  flatness = is_line ? 0 : 1 - std::sqrt(variances[0] / variances[1]);
}

Ball Ball::moved(const Matrix3& linear) const {
  Ball ball = *this;
  ball.mean = linear * mean;
  ball.axes = linear * axes;
  return ball;
}

BallSupport::BallSupport(const Ball& own, const Ball& other, const Tolerance& tolerance) {
  if (other.count < least || own.count < least) {
    (other.count < least ? missing : rim) = 1;
    return;
  }
  const Vector3 gap = own.mean - other.mean;
  // Less twice the variance that few points leave to the gap.
  const auto across = [&](const Ball& ball) {
    const Vector3 along = ball.axes.transpose() * gap;
    const Vector3 left = along.cwiseAbs2() - 4 / ball.effective * ball.variances;
    return ball.thinness.dot(left);
  };
  // At a rim, where one ball holds but a strip, the other shows which way the surface goes.
  const double one = across(own), two = across(other);
  const auto [less, more] = std::minmax(own.count, other.count);
  const double of_whole = more == other.count ? two : one;
  const double shared = std::clamp((less / more - strip) / (whole - strip), 0.0, 1.0);
  const double offset = std::max(0.0, shared * std::max(one, two) + (1 - shared) * of_whole);
  const double complete = std::min(1.0, less / (whole * more));
  const double cosine = own.normal().dot(other.normal());
  const double turned = own.flatness * other.flatness * (1 - squared(cosine));
  const double missed = offset / squared(tolerance.far);
  support = complete * (squared(1 - turned) / (1 + offset / squared(tolerance.near)) -
                        penalty * missed * std::exp(1 - missed));
  (more == other.count ? rim : missing) = 1 - complete;
  apart = std::sqrt(offset);
}

}  // namespace symsurf
