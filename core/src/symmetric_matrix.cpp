#include "symmetric_matrix.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace symsurf {

template <int n>
SymmetricEigen<n> eigen_of(const Eigen::Matrix<double, n, n>& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, n, n>> eigen(symmetric);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

template <int n>
Eigen::Vector<double, n> solved(const Eigen::Matrix<double, n, n>& semidefinite,
                                const Eigen::Vector<double, n>& right) {
  return semidefinite.ldlt().solve(right);
}

template SymmetricEigen<2> eigen_of(const Eigen::Matrix<double, 2, 2>&);
template SymmetricEigen<3> eigen_of(const Eigen::Matrix<double, 3, 3>&);

template Eigen::Vector<double, 3> solved(const Eigen::Matrix<double, 3, 3>&,
                                         const Eigen::Vector<double, 3>&);
template Eigen::Vector<double, 4> solved(const Eigen::Matrix<double, 4, 4>&,
                                         const Eigen::Vector<double, 4>&);
template Eigen::Vector<double, 5> solved(const Eigen::Matrix<double, 5, 5>&,
                                         const Eigen::Vector<double, 5>&);
template Eigen::Vector<double, 6> solved(const Eigen::Matrix<double, 6, 6>&,
                                         const Eigen::Vector<double, 6>&);
template Eigen::Vector<double, 10> solved(const Eigen::Matrix<double, 10, 10>&,
                                          const Eigen::Vector<double, 10>&);

}  // namespace symsurf
