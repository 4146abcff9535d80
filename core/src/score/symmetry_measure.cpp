#include "score/symmetry_measure.h"

#include <cmath>
#include <numeric>

namespace symsurf {

double wendland(double u) {
  const double v = 1 - u;
  return v * v * v * v * v * (8 * u * u + 5 * u + 1);
}

double wendland_slope(double u) {
  const double v = 1 - u;
  return -14 * v * v * v * v * (4 * u + 1);
}

SymmetryMeasure::SymmetryMeasure(const Points& points) {
  const Eigen::RowVector3d centroid = points.colwise().mean();
  const double extent = (points.rowwise() - centroid).rowwise().norm().mean();
  alpha_ = 15 / (extent > 0 ? extent : 1);  // of points at one position any will do
  support_ = 2.6 / alpha_;
  origin_ = points.colwise().minCoeff().transpose();
  const auto cell = [&](Index i) -> Eigen::Vector3i {
    return ((points.row(i).transpose() - origin_) / support_).cast<int>();
  };
  const Vector3 high = points.colwise().maxCoeff().transpose();
  size_ = ((high - origin_) / support_).cast<int>().array() + 1;
  const auto linear = [&](const Eigen::Vector3i& c) {
    return (static_cast<Index>(c.x()) * size_.y() + c.y()) * size_.z() + c.z();
  };

  start_.assign(size_.cast<Index>().prod() + 1, 0);
  for (Index i = 0; i < points.rows(); ++i) ++start_[linear(cell(i)) + 1];
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  sorted_.resize(points.rows(), 3);
  std::vector<std::int32_t> next(start_.begin(), start_.end() - 1);
  for (Index i = 0; i < points.rows(); ++i) sorted_.row(next[linear(cell(i))]++) = points.row(i);
}

double SymmetryMeasure::similarity(const Vector3& image, Vector3& pull) const {
  const double inverse_support = 1 / support_;
  pull.setZero();
  const Vector3 at = (image - origin_) * inverse_support;
  if (!((at.array() > -1).all() && (at.array() < size_.cast<double>().array() + 1).all())) return 0;
  const Eigen::Vector3i centre = at.array().floor().cast<int>();
  const Eigen::Vector3i from = (centre.array() - 1).max(0);
  const Eigen::Vector3i to = (centre.array() + 1).min(size_.array() - 1);
  if (from.z() > to.z()) return 0;
  double sum = 0;
  for (int cx = from.x(); cx <= to.x(); ++cx)
    for (int cy = from.y(); cy <= to.y(); ++cy) {
      const Index row = (static_cast<Index>(cx) * size_.y() + cy) * size_.z();
      for (std::int32_t j = start_[row + from.z()]; j < start_[row + to.z() + 1]; ++j) {
        const Vector3 chord = image - sorted_.row(j).transpose();
        const double uu = chord.squaredNorm() * inverse_support * inverse_support;
        if (uu >= 1) continue;
        const double u = std::sqrt(uu);
        sum += wendland(u);
        pull += wendland_slope(u) * chord;
      }
    }
  pull *= inverse_support * inverse_support;
  return sum;
}

double SymmetryMeasure::operator()(const Eigen::Vector4d& p, Eigen::Vector4d* gradient) const {
  const Vector3 n = p.head<3>();
  const double nn = n.squaredNorm();
  double sum = 0;
  Vector3 by_normal = Vector3::Zero();
  double by_offset = 0;
  for (Index i = 0; i < size(); ++i) {
    const Vector3 x = point(i);
    const double l = n.dot(x) + p[3];
    Vector3 pull;
    sum += similarity(x - 2 * l / nn * n, pull);
    const double along = n.dot(pull);
    by_offset += along;
    by_normal += along * x - 2 * l * along / nn * n + l * pull;
  }
  if (gradient) {
    gradient->head<3>() = -2 / nn * by_normal;
    (*gradient)[3] = -2 / nn * by_offset;
  }
  return sum;
}

}  // namespace symsurf
