#pragma once

#include <symsurf/points.h>

#include <Eigen/Core>

namespace symsurf {

/// x of A x = b for a semidefinite A by L D L' with pivots (Golub and Van Loan, 4.2); 0 along what
/// A leaves open. Looks at the lower triangle.
Eigen::VectorXd solved(const Eigen::MatrixXd& semidefinite, const Eigen::VectorXd& right);

/// The same in less time, where many are solved.
template <int n>
requires(n >= 3 &&
         n <= 5) Eigen::Vector<double, n> solved(const Eigen::Matrix<double, n, n>& semidefinite,
                                                 const Eigen::Vector<double, n>& right);

/// Weighted least squares fit of z = h . (1, u, v, u^2, u v, v^2).
class QuadraticFit {
 public:
  using Coefficients = Eigen::Vector<double, 6>;

  void add(double u, double v, double z, double weight = 1) {
    const Coefficients row{{1, u, v, u * u, u * v, v * v}};
    normal_.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
    right_ += weight * z * row;
  }

  /// The sum of all.
  double weight() const { return normal_(0, 0); }

  /// h, its second derivatives, slopes and height drawn to 0 by ridges on the diagonal of the
  /// normal equations.
  Coefficients coefficients(double bends = 0, double slopes = 0, double height = 0) const {
    Eigen::Matrix<double, 6, 6> ridged = normal_;
    ridged.diagonal() += Coefficients{{height, slopes, slopes, bends, bends, bends}};
    return solved(ridged, right_);
  }

 private:
  Eigen::Matrix<double, 6, 6> normal_ = Eigen::Matrix<double, 6, 6>::Zero();  // lower triangle
  Coefficients right_ = Coefficients::Zero();
};

}  // namespace symsurf
