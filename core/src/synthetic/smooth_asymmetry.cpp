#include "synthetic/smooth_asymmetry.h"

#include <Eigen/Geometry>
#include <cmath>

#include "base/symmetric_eigen.h"
#include "synthetic/benchmark_mirror.h"
#include "synthetic/portable_sine.h"

namespace symsurf {

namespace {

// Turns one unit vector into another that is not its opposite.
Matrix3 turn(const Vector3& from, const Vector3& to) {
  const Vector3 axis = from.cross(to);
  Matrix3 cross;
  cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return Matrix3::Identity() + cross + cross * cross / (1 + from.dot(to));
}

}  // namespace

SmoothAsymmetry::SmoothAsymmetry(double share, const std::vector<Vector3>& points, Random& random) {
  constexpr int waves = 5;
  constexpr double shortest = 0.7, longest = 2;  // wavelengths
  for (int k = 0; k < waves; ++k) {
    const double wavelength = random.uniform(shortest, longest);
    const Vector3 along = random.direction() / wavelength;
    const double phase = random.uniform();
    waves_.push_back({along, phase, random.direction()});
  }
  if (share == 0) return;
  strength_ = 1;
  double squares = 0;
  for (const Vector3& x : points) squares += (displaced(x) - x).squaredNorm();
  strength_ = share / std::sqrt(squares / static_cast<double>(points.size()));

  // The plane n . (x - c) = 0 that takes displaced points p to their images q with the least sum of
  // squares goes through the mean of all; n is the least eigenvector of the sum of p q' + q p'.
  for (const Vector3& x : points) centre_ += (displaced(x) + displaced(over_mirror(x))) / 2;
  centre_ /= static_cast<double>(points.size());
  Matrix3 products = Matrix3::Zero();
  double bound = 0;
  for (const Vector3& x : points) {
    const Vector3 p = displaced(x) - centre_, q = displaced(over_mirror(x)) - centre_;
    products += p * q.transpose() + q * p.transpose();
    bound += p.squaredNorm() + q.squaredNorm();
  }
  products.diagonal().array() += bound;
  Vector3 normal = least_eigen_of(products).vector;
  if (normal.z() < 0) normal = -normal;
  rotation_ = turn(normal, Vector3::UnitZ());
}

Vector3 SmoothAsymmetry::displaced(const Vector3& x) const {
  Vector3 sum = x;
  for (const Wave& wave : waves_)
    sum += strength_ * sine_of_turns(wave.along.dot(x) + wave.phase) * wave.way;
  return sum;
}

Vector3 SmoothAsymmetry::operator()(const Vector3& x) const {
  if (strength_ == 0) return x;
  return rotation_ * (displaced(x) - centre_);
}

}  // namespace symsurf
