#include "symmetric_matrix.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace symsurf {

// Through any size, which the pencils below need as well.
SymmetricEigen<2> eigen_of(const Eigen::Matrix2d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(symmetric);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

SymmetricEigen<3> eigen_of(const Eigen::Matrix3d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(symmetric);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

SymmetricEigen<Eigen::Dynamic> eigen_of(const Eigen::MatrixXd& symmetric,
                                        const Eigen::MatrixXd& definite) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(symmetric, definite);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

template <int n>
Eigen::Vector<double, n> solved(const Eigen::Matrix<double, n, n>& semidefinite,
                                const Eigen::Vector<double, n>& right) {
  return semidefinite.ldlt().solve(right);
}

template Eigen::Vector3d solved(const Eigen::Matrix3d&, const Eigen::Vector3d&);
template Eigen::Vector4d solved(const Eigen::Matrix4d&, const Eigen::Vector4d&);
template Eigen::Vector<double, 5> solved(const Eigen::Matrix<double, 5, 5>&,
                                         const Eigen::Vector<double, 5>&);
template Eigen::Vector<double, 6> solved(const Eigen::Matrix<double, 6, 6>&,
                                         const Eigen::Vector<double, 6>&);
template Eigen::VectorXd solved(const Eigen::MatrixXd&, const Eigen::VectorXd&);

}  // namespace symsurf
