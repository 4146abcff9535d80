#include "free_form_blend.h"

#include <Eigen/Dense>
#include <cmath>

namespace symsurf {

namespace {

Points centres_of(const std::vector<Patch>& patches) {
  Points centres(static_cast<Index>(patches.size()), 3);
  for (Index i = 0; i < centres.rows(); ++i) centres.row(i) = patches[i].centre.transpose();
  return centres;
}

}  // namespace

FreeForm::Blend::Blend(std::vector<Patch> patches)
    : patches_(std::move(patches)), centres_(centres_of(patches_)), tree_(centres_) {
  for (const Patch& p : patches_) {
    reach_ = std::max(reach_, p.radius);
    Matrix3 bend = Matrix3::Zero();
    bend(0, 0) = 2 * p.height[3];
    bend(0, 1) = bend(1, 0) = p.height[4];
    bend(1, 1) = 2 * p.height[5];
    hessians_.push_back(-p.frame.transpose() * bend * p.frame);
  }
}

bool FreeForm::Blend::jet(const Vector3& x, Jet& jet) const {
  double weights = 0, value = 0;
  Vector3 slope = Vector3::Zero(), weights_slope = Vector3::Zero(), value_slope = Vector3::Zero();
  Matrix3 hessian = Matrix3::Zero(), mixed = Matrix3::Zero();
  tree_.within(x, reach_, [&](Index i, double squared) {
    const Patch& p = patches_[i];
    const double inside = 1 - squared / (p.radius * p.radius);
    if (inside <= 0) return;
    const double weight = inside * inside * inside;
    const Vector3 d = x - p.centre, local = p.frame * d;
    const double s = local.x(), t = local.y();
    const auto& h = p.height;
    const double q =
        local.z() - (h[0] + h[1] * s + h[2] * t + h[3] * s * s + h[4] * s * t + h[5] * t * t);
    const Vector3 g(-(h[1] + 2 * h[3] * s + h[4] * t), -(h[2] + h[4] * s + 2 * h[5] * t), 1);
    const Vector3 weight_slope = -6 * inside * inside / (p.radius * p.radius) * d;
    weights += weight;
    value += weight * q;
    const Vector3 turned = p.frame.transpose() * g;
    slope += weight * turned;
    weights_slope += weight_slope;
    value_slope += weight_slope * q;
    hessian += weight * hessians_[i];
    mixed += weight_slope * turned.transpose();
  });
  if (!(weights > 0)) return false;
  jet.value = value / weights;
  jet.gradient = (slope + value_slope - jet.value * weights_slope) / weights;
  mixed -= weights_slope * jet.gradient.transpose();
  jet.hessian = (hessian + mixed + mixed.transpose()) / weights;
  return true;
}

bool FreeForm::Blend::value(const Vector3& x, double& value, Vector3& gradient) const {
  Jet here;
  if (!jet(x, here)) return false;
  value = here.value;
  gradient = here.gradient;
  return true;
}

// Newton's method on the conditions of the closest point, x - y = lambda g and f(y) = 0. The
// hessian leaves out the weights' second derivatives, which vanish on the surface where the patches
// agree: steps are a little off, their limit is not.
bool FreeForm::Blend::descend(const Vector3& x, double precision, Vector3& y,
                              Vector3& normal) const {
  const int most_steps = precision < 1e-6 ? 30 : 10;
  const double longest = 0.5 * reach_, enough = precision * (reach_ + (x - y).norm());
  Jet here;
  double lambda = 0;
  for (int step = 0; step < most_steps; ++step) {
    if (!jet(y, here)) return false;
    const Vector3& g = here.gradient;
    const double squared = g.squaredNorm();
    if (!(squared > 0)) return false;
    if (step == 0) lambda = g.dot(x - y) / squared;
    Matrix3 a = Matrix3::Identity() + lambda * here.hessian;
    // Beyond the centre of curvature the step would climb: walk along the tangent plane instead.
    if (Eigen::LLT<Matrix3>(a).info() != Eigen::Success) a.setIdentity();
    const Matrix3 inverse = a.inverse();
    const Vector3 ag = inverse * g, gap = x - y;
    lambda = (ag.dot(gap) + here.value) / ag.dot(g);
    Vector3 move = inverse * (gap - lambda * g);
    const double length = move.norm();
    if (!std::isfinite(length)) return false;
    if (length > longest) move *= longest / length;
    y += move;
    if (length <= enough || (step > 12 && length <= 1e3 * enough)) {
      normal = g.normalized();
      return true;
    }
  }
  return false;
}

bool FreeForm::Blend::closest(const Vector3& x, double precision, Vector3& foot,
                              Vector3& normal) const {
  const Neighbour start = tree_.nearest(x);
  foot = patches_[start.index].centre;
  return descend(x, precision, foot, normal);
}

}  // namespace symsurf
