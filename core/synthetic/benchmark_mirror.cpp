#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/linear_algebra.h"
#include "generators.h"

namespace symsurf {

namespace {

constexpr double tau = 6.283185307179586476925;
constexpr double steepest = 0.7;  // of a radius of curvature, how far a body may reach

}  // namespace

BenchmarkMirror::BenchmarkMirror(std::string_view bend, double reach, Random& random)
    : bend_(bend == "bent"      ? Bend::Bent
            : bend == "domed"   ? Bend::Domed
            : bend == "waved"   ? Bend::Waved
            : bend == "twisted" ? Bend::Twisted
                                : Bend::Straight) {
  const Vector3 way = random.direction();
  const double length = std::sqrt(way.x() * way.x() + way.y() * way.y());
  if (length > 0) {
    along_x_ = way.x() / length;
    along_y_ = way.y() / length;
  }
  radius_ = std::max(random.uniform(0.5, 1.2), reach / steepest);
  amplitude_ = random.uniform(0.03, 0.1);
  phase_ = random.uniform();
  // The curvature of a wave is at most amplitude * (tau * frequency)^2.
  frequency_ = std::min(random.uniform(0.7, 1.3), std::sqrt(steepest / (reach * amplitude_)) / tau);
  slope_ = std::min(random.uniform(0.3, 1), steepest / reach);
}

Vector3 BenchmarkMirror::bent(const Vector3& x) const {
  const double u = along_x_ * x.x() + along_y_ * x.y(), v = along_x_ * x.y() - along_y_ * x.x();
  const double turns = tau * radius_;  // around
  switch (bend_) {
    case Bend::Straight:
      return {u, v, x.z()};
    case Bend::Bent: {
      const double s = sine_of_turns(u / turns), c = cosine_of_turns(u / turns);
      return {(radius_ + x.z()) * s, v, (radius_ + x.z()) * c - radius_};
    }
    case Bend::Domed: {  // equidistant from the pole
      const double arc = std::sqrt(u * u + v * v);
      const double s = arc > 0 ? sine_of_turns(arc / turns) / arc : 1 / radius_;
      const double c = cosine_of_turns(arc / turns), r = radius_ + x.z();
      return {r * s * u, r * s * v, r * c - radius_};
    }
    case Bend::Waved: {
      const double turn = frequency_ * u + phase_;
      const double slope = amplitude_ * tau * frequency_ * cosine_of_turns(turn);
      const double h = x.z() / std::sqrt(1 + slope * slope);
      return {u - h * slope, v, amplitude_ * sine_of_turns(turn) + h};
    }
    case Bend::Twisted: {
      const double a = slope_ * v, b = slope_ * u, h = x.z() / std::sqrt(1 + a * a + b * b);
      return {u - h * a, v - h * b, slope_ * u * v + h};
    }
  }
  return x;
}

Vector3 BenchmarkMirror::straightened(const Vector3& x, const Vector3& start) const {
  constexpr double step = 1e-6, rounding = 1e-15;
  constexpr int most = 20;
  Vector3 at = start;
  for (int iteration = 0; iteration < most; ++iteration) {
    const Vector3 gap = x - bent(at);
    if (gap.squaredNorm() < rounding * rounding) break;
    Vector3 slope[3];
    for (int axis = 0; axis < 3; ++axis) {
      Vector3 ahead = at, behind = at;
      ahead[axis] += step;
      behind[axis] -= step;
      slope[axis] = (bent(ahead) - bent(behind)) / (2 * step);
    }
    // Cramer's rule.
    const double volume = slope[0].dot(slope[1].cross(slope[2]));
    at += Vector3(gap.dot(slope[1].cross(slope[2])), gap.dot(slope[2].cross(slope[0])),
                  gap.dot(slope[0].cross(slope[1]))) /
          volume;
  }
  return at;
}

std::string BenchmarkMirror::kind() const {
  switch (bend_) {
    case Bend::Straight:
      return "plane";
    case Bend::Bent:
      return "cylinder";
    case Bend::Domed:
      return "sphere";
    default:
      return "graph";
  }
}

Values BenchmarkMirror::mirror(double scale, const Matrix3& rotation,
                               const Vector3& translation) const {
  const Vector3 centre = scale * (rotation * Vector3(0, 0, -radius_)) + translation;
  switch (bend_) {
    case Bend::Straight: {
      const Vector3 normal = rotation.col(2);
      return {{"normal", normal}, {"offset", -normal.dot(translation)}};
    }
    case Bend::Bent:
      return {{"point", centre}, {"axis", Vector3(rotation.col(1))}, {"radius", scale * radius_}};
    case Bend::Domed:
      return {{"centre", centre}, {"radius", scale * radius_}};
    default:
      break;
  }
  Values values{{"scale", scale}, {"translation", translation}};
  values["rotation"] = Eigen::MatrixXd(rotation);
  if (bend_ == Bend::Waved) {
    values["formula"] = std::string("z = amplitude sin(2 pi (frequency x + phase))");
    values["amplitude"] = amplitude_;
    values["frequency"] = frequency_;
    values["phase"] = phase_;
  } else {
    values["formula"] = std::string("z = slope x y");
    values["slope"] = slope_;
  }
  return values;
}

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
