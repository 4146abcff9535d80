#include <symsurf/cylinder.h>

#include <Eigen/Dense>
#include <cmath>

#include "parametric.h"

namespace symsurf::perpendicular {

namespace {

class CylinderModel final : public Model {
 public:
  CylinderModel(const Vector3& point, const Vector3& axis, double radius)
      : point_(point), axis_(axis.normalized()), radius_(radius) {
    frame();
  }

  std::unique_ptr<Model> copy() const override { return std::make_unique<CylinderModel>(*this); }
  int size() const override { return 5; }

  std::unique_ptr<Mirror> mirror() const override {
    const bool sound = point_.allFinite() && axis_.allFinite() && radius_ > 0 && radius_ < 1e6;
    return sound ? std::make_unique<Cylinder>(point_, axis_, radius_) : nullptr;
  }

  // x' = x - 2 (1 - R / |v|) v with v = (I - a a') (x - p).
  bool image(const Vector3& x, Vector3& image, Jacobian& derivatives) const override {
    const Vector3 d = x - point_, v = d - d.dot(axis_) * axis_;
    const double rho = v.norm();
    if (!(rho > 0) || rho > 2 * radius_) return false;
    const Vector3 u = v / rho;
    image = x - 2 * (rho - radius_) * u;
    const Matrix3 by_v =
        -2 * ((1 - radius_ / rho) * Matrix3::Identity() + radius_ / rho * u * u.transpose());
    const Vector3 sides[] = {first_, second_};
    for (int k = 0; k < 2; ++k) {
      derivatives.col(k) = by_v * -sides[k];
      derivatives.col(2 + k) = by_v * (-d.dot(sides[k]) * axis_ - d.dot(axis_) * sides[k]);
    }
    derivatives.col(4) = 2 * u;
    return true;
  }

  void step(const Eigen::VectorXd& by) override {
    point_ += by[0] * first_ + by[1] * second_;
    axis_ = (axis_ + by[2] * first_ + by[3] * second_).normalized();
    radius_ += by[4];
    frame();
  }

 private:
  void frame() {
    first_ = axis_.unitOrthogonal();
    second_ = axis_.cross(first_);
    // The axis turns about the point nearest to the cloud's middle.
    point_ -= point_.dot(axis_) * axis_;
  }

  Vector3 point_, axis_, first_, second_;
  double radius_;
};

}  // namespace

// The axis is orthogonal to all normals; then the circle m = c + R n by least squares.
std::unique_ptr<Model> cylinder_model(const Sheet& sheet) {
  if (sheet.carried.size() < 6) return nullptr;
  Matrix3 spread = Matrix3::Zero();
  Vector3 mean_foot = Vector3::Zero(), mean_normal = Vector3::Zero();
  const double count = static_cast<double>(sheet.carried.size());
  for (const Carried& c : sheet.carried) {
    spread += c.normal * c.normal.transpose();
    mean_foot += c.foot / count;
    mean_normal += c.normal / count;
  }
  const Vector3 axis = Eigen::SelfAdjointEigenSolver<Matrix3>(spread).eigenvectors().col(0);
  const Matrix3 across = Matrix3::Identity() - axis * axis.transpose();
  double both = 0, normals = 0;
  for (const Carried& c : sheet.carried) {
    const Vector3 m = across * (c.foot - mean_foot), n = across * (c.normal - mean_normal);
    both += m.dot(n);
    normals += n.squaredNorm();
  }
  if (!(normals > 0) || both == 0) return nullptr;
  const double radius = both / normals;  // negative where the normals point inwards
  const Vector3 point = mean_foot - radius * mean_normal;
  if (!(std::abs(radius) < 1e3)) return nullptr;
  return std::make_unique<CylinderModel>(point, axis, std::abs(radius));
}

}  // namespace symsurf::perpendicular
