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

Eigen::Isometry3d nearest_isometry(const std::vector<std::pair<Vector3, Vector3>>& pairs,
                                   double parity) {
  const auto count = static_cast<double>(pairs.size());
  Vector3 from = Vector3::Zero(), onto = Vector3::Zero();
  for (const auto& [x, y] : pairs) {
    from += x / count;
    onto += y / count;
  }
  Matrix3 products = Matrix3::Zero();
  for (const auto& [x, y] : pairs) products += (y - onto) * (x - from).transpose();
  return map_taking(nearest_orthogonal(products, parity), from, onto);
}

Eigen::Isometry3d map_taking(const Matrix3& linear, const Vector3& from, const Vector3& onto) {
  Eigen::Isometry3d map = Eigen::Isometry3d::Identity();
  map.linear() = linear;
  map.translation() = onto - linear * from;
  return map;
}

}  // namespace symsurf
