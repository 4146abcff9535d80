#include <symsurf/attributes.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/parallel.h"

namespace symsurf {

namespace {

constexpr Index stretch = 1024;  // Jacobians; some ten microseconds each over a free-form mirror

bool is_flat(const Mirror& mirror) {
  return mirror.kind() == "plane" || mirror.kind() == "oblique plane";
}

// By how much a point was turned about an axis, radians; by one of finite order whole steps.
double turn_about(const Values& axis, const Vector3& before, const Vector3& after) {
  const auto& centre = std::get<Vector3>(axis.at("axis_point"));
  const Vector3 direction = std::get<Vector3>(axis.at("axis_direction")).normalized(),
                from = (before - centre).cross(direction), onto = (after - centre).cross(direction);
  const double turn = std::atan2(from.cross(onto).dot(direction), from.dot(onto));
  const auto order = static_cast<double>(std::get<Index>(axis.at("axis_order")));
  const double step = 2 * std::numbers::pi / order;
  return order > 0 ? step * std::round(turn / step) : turn;
}

Eigen::RowVectorXd transformed(Eigen::RowVectorXd value, AttributeKind kind, const Matrix3& j) {
  if (kind == AttributeKind::Vector) return value * j.transpose();
  if (kind == AttributeKind::Normal) {
    // The cofactors are J^-T but for the determinant: sound where J has no inverse.
    Matrix3 cofactors;
    for (int i = 0; i < 3; ++i) cofactors.col(i) = j.col((i + 1) % 3).cross(j.col((i + 2) % 3));
    const Vector3 normal = cofactors * value.transpose();
    const double length = std::copysign(normal.norm(), j.determinant());
    return normal.transpose() * (length == 0 ? 1 : value.norm() / length);
  }
  constexpr int six[] = {0, 3, 5, 3, 1, 4, 5, 4, 2};
  const auto entry = [&](int k) -> double& { return value[value.size() == 9 ? k : six[k]]; };
  Matrix3 tensor;
  for (int k = 0; k < 9; ++k) tensor(k) = entry(k);
  tensor = j * tensor * j.transpose();
  for (int k = 0; k < 9; ++k) entry(k) = tensor(k);
  return value;
}

}  // namespace

AttributeTransform::AttributeTransform(const Mirror& mirror, PointsView points,
                                       const Context& context)
    : points_(points), mirror_(&mirror), context_(context), parents_(points.size(), 1) {
  std::iota(parents_.data(), parents_.data() + parents_.size(), Index{0});
  jacobian_of_ = is_flat(mirror) ? Rows::Zero(points.size(), 1) : parents_;
  shares_.setOnes(points.size(), 1);
}

AttributeTransform::AttributeTransform(const OperationResult& result, PointsView points,
                                       const Mirror* mirror, const Context& context)
    : points_(points),
      mirror_(mirror),
      context_(context),
      parents_(result.point_parents),
      shares_(result.point_shares) {
  const Index rows = result.points.rows();
  if (parents_.rows() == 0) {
    parents_.resize(rows, 1);
    std::iota(parents_.data(), parents_.data() + rows, Index{0});
    std::copy(result.point_sources.begin(), result.point_sources.end(), parents_.data());
    shares_.setOnes(rows, 1);
  }
  if (rows > 0 && !(parents_.minCoeff() >= 0 && parents_.maxCoeff() < points.size()))
    throw InvalidInput("the result is not one of " + std::to_string(points.size()) + " points");
  jacobian_of_.setConstant(rows, parents_.cols(), -1);
  const auto array = [&](const char* name) {
    const auto found = result.arrays.find(name);
    return found == result.arrays.end() ? nullptr : &found->second;
  };
  const auto *partner = array("partner"), *origin = array("origin");
  const auto matrix = result.statistics.find("matrix");
  if (matrix != result.statistics.end()) {
    jacobians_ = {std::get<Eigen::MatrixXd>(matrix->second).topLeftCorner<3, 3>()};
    jacobian_of_.setZero();
  } else if (result.statistics.count("axis_direction") > 0) {
    const Vector3 axis = std::get<Vector3>(result.statistics.at("axis_direction")).normalized();
    for (Index i = 0; i < rows; ++i) {
      if ((*origin)(i, 0) == 0) continue;
      const double turn =
          turn_about(result.statistics, points[parents_(i, 0)], result.points.row(i));
      jacobian_of_(i, 0) = static_cast<Index>(jacobians_.size());
      jacobians_.push_back(Eigen::AngleAxisd(turn, axis).toRotationMatrix());
    }
  } else if (mirror && result.operation == "straighten") {
    if (is_flat(*mirror)) return;
    bend_ = std::get<bool>(result.parameters.at("back")) ? Bend::Restore : Bend::Straighten;
    jacobian_of_ = parents_;
  } else if (mirror && (partner || origin || result.operation == "transfer")) {
    for (Index i = 0; i < rows; ++i)
      for (Index k = 0; k < parents_.cols(); ++k) {
        // Images follow the points that they are images of; of values the own ones come first.
        const bool is_image = partner  ? (*partner)(i, 0) < static_cast<double>(i)
                              : origin ? (*origin)(i, 0) > 0
                                       : k > 0;
        if (is_image && shares_(i, k) > 0)
          jacobian_of_(i, k) = is_flat(*mirror) ? 0 : parents_(i, k);
      }
  }
}

const std::vector<Matrix3>& AttributeTransform::jacobians() const {
  if (!jacobians_.empty() || !turns()) return jacobians_;
  std::vector<Matrix3> found(points_.size());
  if (is_flat(*mirror_))
    found = {mirror_->jacobian(Vector3::Zero())};
  else if (bend_)
    bend(points_, *mirror_, *bend_, context_, nullptr, &found);
  else
    parallel_for(context_, points_.size(), stretch, [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i) found[i] = mirror_->jacobian(points_[i]);
    });
  jacobians_ = std::move(found);
  return jacobians_;
}

Eigen::MatrixXd AttributeTransform::operator()(const Eigen::MatrixXd& values,
                                               AttributeKind kind) const {
  const Index columns = values.cols();
  const bool is_tensor = kind == AttributeKind::Tensor;
  if (values.rows() != points_.size() ||
      (is_tensor ? columns != 6 && columns != 9 : kind != AttributeKind::Scalar && columns != 3))
    throw InvalidInput(
        "values have the shape (" + std::to_string(values.rows()) + ", " + std::to_string(columns) +
        "); allowed are " + std::to_string(points_.size()) +
        " rows and, by the kind, 3 columns of vectors and normals, 6 or 9 of tensors");
  const std::vector<Matrix3>& jacobians = this->jacobians();
  Eigen::MatrixXd made = Eigen::MatrixXd::Zero(parents_.rows(), columns);
  for (Index i = 0; i < made.rows(); ++i) {
    double longest = 0;
    for (Index k = 0; k < parents_.cols(); ++k) {
      const double share = shares_(i, k);
      if (share == 0) continue;
      Eigen::RowVectorXd value = values.row(parents_(i, k));
      longest = std::max(longest, value.norm());
      if (const Index j = jacobian_of_(i, k); j >= 0 && kind != AttributeKind::Scalar)
        value = transformed(value, kind, jacobians[j]);
      made.row(i) += share * value;
    }
    const double length = made.row(i).norm();
    if (kind == AttributeKind::Normal && length > 0) made.row(i) *= longest / length;
  }
  return made;
}

}  // namespace symsurf
