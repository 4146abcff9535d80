#include "search/nearest_simple.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/eigenvectors.h"
#include "base/least_squares.h"

namespace symsurf {

namespace {

// Of the rows from the sphere, or circle, that fits them: |x - c|^2 = r^2 is linear in c and
// r^2 - |c|^2. Flat ones fit a straight one better than any that this finds.
template <int n>
double distance_from_round(const Eigen::Matrix<double, Eigen::Dynamic, n>& rows) {
  const auto count = static_cast<double>(rows.rows());
  Eigen::Matrix<double, Eigen::Dynamic, n> unit = rows.rowwise() - rows.colwise().mean();
  const double size = std::sqrt(unit.squaredNorm() / count);
  if (!(size > 0)) return 0;
  unit /= size;
  const Eigen::Matrix<double, n, n> scatter = unit.transpose() * unit;
  const double flat = std::sqrt(std::max(0.0, eigen_of(scatter).values[0]) / count);
  Eigen::MatrixXd design(rows.rows(), n + 1);
  design << 2 * unit, Eigen::VectorXd::Ones(rows.rows());
  const Eigen::VectorXd fit =
      solved(design.transpose() * design, design.transpose() * unit.rowwise().squaredNorm());
  const Eigen::Vector<double, n> centre = fit.head<n>();
  const double radius = std::sqrt(std::max(0.0, fit[n] + centre.squaredNorm()));
  const Eigen::VectorXd off =
      (unit.rowwise() - centre.transpose()).rowwise().norm().array() - radius;
  return size * std::min(flat, std::sqrt(off.squaredNorm() / count));
}

Points centres_of(const FreeForm& mirror) {
  Points centres(static_cast<Index>(mirror.patches().size()), 3);
  for (Index i = 0; i < centres.rows(); ++i)
    centres.row(i) = mirror.patches()[i].centre.transpose();
  return centres;
}

}  // namespace

double distance_from_sphere(const FreeForm& mirror) {
  return distance_from_round<3>(centres_of(mirror));
}

double distance_from_cylinder(const FreeForm& mirror) {
  Matrix3 normals = Matrix3::Zero();
  for (const Patch& patch : mirror.patches())
    normals += patch.frame.row(2).transpose() * patch.frame.row(2);
  const Matrix3 axes = eigen_of(normals).vectors;
  return distance_from_round<2>(centres_of(mirror) * axes.rightCols<2>());
}

}  // namespace symsurf
