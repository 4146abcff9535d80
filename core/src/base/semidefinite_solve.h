#pragma once

#include <symsurf/points.h>

namespace symsurf {

/// x of A x = b for a semidefinite A by L D L' with pivots (Golub and Van Loan, 4.2); 0 along what
/// A leaves open. Looks at the lower triangle.
Eigen::VectorXd solved(const Eigen::MatrixXd& semidefinite, const Eigen::VectorXd& right);

/// The same in less time, where many are solved.
template <int n>
requires(n == 4 ||
         n == 5) Eigen::Vector<double, n> solved(const Eigen::Matrix<double, n, n>& semidefinite,
                                                 const Eigen::Vector<double, n>& right);

}  // namespace symsurf
