#pragma once

#include <symsurf/types.h>

namespace symsurf {

// Eigen's decompositions are slow to compile: those of symmetric matrices, which many searches
// need, are compiled here alone. They look at the lower triangle.

/// Eigenvalues, ascending, and unit eigenvectors, one a column.
template <int n>
struct SymmetricEigen {
  Eigen::Vector<double, n> values;
  Eigen::Matrix<double, n, n> vectors;
};

/// By tridiagonalisation and implicit QR steps (Golub and Van Loan, "Matrix Computations", 8.3).
SymmetricEigen<2> eigen_of(const Eigen::Matrix2d& symmetric);
SymmetricEigen<3> eigen_of(const Eigen::Matrix3d& symmetric);

/// The same of A v = lambda B v, v' B v = 1, for a positive definite B (Golub and Van Loan, 8.7).
SymmetricEigen<Eigen::Dynamic> eigen_of(const Eigen::MatrixXd& symmetric,
                                        const Eigen::MatrixXd& definite);

/// The least eigenvalue of a semidefinite matrix with its unit eigenvector, and the others.
struct LeastEigen {
  double value, next, greatest;
  Vector3 vector;
};

/// In a quarter of the time of eigen_of: Newton's steps on the characteristic polynomial, from
/// below, then inverse iterations with the adjugate in the inverse's place (Golub and Van Loan,
/// 7.6.1). For entries that have a fourth power.
LeastEigen least_eigen_of(const Matrix3& semidefinite);

/// x of A x = b for a semidefinite A by L D L' with pivots (Golub and Van Loan, 4.2); 0 along what
/// A leaves open. n is 3 to 6 or any (Eigen::Dynamic).
template <int n>
Eigen::Vector<double, n> solved(const Eigen::Matrix<double, n, n>& semidefinite,
                                const Eigen::Vector<double, n>& right);

}  // namespace symsurf
