#include "base/nearest_orthogonal.h"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace symsurf {

Matrix3 nearest_orthogonal(const Matrix3& products, double parity) {
  const Eigen::JacobiSVD<Matrix3> svd(products, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double turned = svd.matrixU().determinant() * svd.matrixV().determinant() * parity;
  return svd.matrixU() * Vector3(1, 1, turned > 0 ? 1 : -1).asDiagonal() *
         svd.matrixV().transpose();
}

}  // namespace symsurf
