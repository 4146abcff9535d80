#include "base/least_squares.h"

#include <Eigen/Cholesky>

namespace symsurf {

Eigen::VectorXd solved(const Eigen::MatrixXd& semidefinite, const Eigen::VectorXd& right) {
  return semidefinite.ldlt().solve(right);
}

template <int n>
requires(n >= 3 &&
         n <= 5) Eigen::Vector<double, n> solved(const Eigen::Matrix<double, n, n>& semidefinite,
                                                 const Eigen::Vector<double, n>& right) {
  return semidefinite.ldlt().solve(right);
}

template Eigen::Vector3d solved(const Eigen::Matrix3d&, const Eigen::Vector3d&);
template Eigen::Vector4d solved(const Eigen::Matrix4d&, const Eigen::Vector4d&);
template Eigen::Vector<double, 5> solved(const Eigen::Matrix<double, 5, 5>&,
                                         const Eigen::Vector<double, 5>&);

}  // namespace symsurf
