#pragma once

#include <Eigen/Core>

namespace symsurf {

// Eigen's decompositions are slow to compile: those of symmetric matrices, which many searches
// need, are compiled here alone. They look at the lower triangle.

/// Eigenvalues, ascending, and unit eigenvectors, one a column.
template <int n>
struct SymmetricEigen {
  Eigen::Vector<double, n> values;
  Eigen::Matrix<double, n, n> vectors;
};

/// By tridiagonalisation and implicit QR steps (Golub and Van Loan, "Matrix Computations", 8.3);
/// n is 2 or 3.
template <int n>
SymmetricEigen<n> eigen_of(const Eigen::Matrix<double, n, n>& symmetric);

/// x of A x = b for a semidefinite A by L D L' with pivots (Golub and Van Loan, 4.2); 0 along what
/// A leaves open. n is 3 to 6 or 10.
template <int n>
Eigen::Vector<double, n> solved(const Eigen::Matrix<double, n, n>& semidefinite,
                                const Eigen::Vector<double, n>& right);

}  // namespace symsurf
