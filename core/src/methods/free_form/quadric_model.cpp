#include <symsurf/quadric.h>

#include <Eigen/LU>

#include "base/semidefinite_solve.h"
#include "methods/free_form/parametric_search.h"

namespace symsurf::perpendicular {

namespace {

using Coefficients = Eigen::Matrix<double, 10, 1>;

// x^2, y^2, z^2, xy, yz, zx, x, y, z, 1
Coefficients monomials(const Vector3& p) {
  Coefficients m;
  m << p.cwiseAbs2(), p.x() * p.y(), p.y() * p.z(), p.z() * p.x(), p, 1;
  return m;
}

Eigen::Matrix<double, 3, 10> slopes(const Vector3& p) {
  Eigen::Matrix<double, 3, 10> s = Eigen::Matrix<double, 3, 10>::Zero();
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    s(a, a) = 2 * p[a];
    s(a, 3 + a) = p[b];
    s(b, 3 + a) = p[a];
    s(a, 6 + a) = 1;
  }
  return s;
}

Quadric quadric_from(const Coefficients& q) {
  Matrix3 matrix;
  matrix << q[0], q[3] / 2, q[5] / 2, q[3] / 2, q[1], q[4] / 2, q[5] / 2, q[4] / 2, q[2];
  return Quadric(matrix, q.segment<3>(6), q[9]);
}

class QuadricModel final : public Model {
 public:
  explicit QuadricModel(const Coefficients& q) : q_(q), quadric_(quadric_from(q)) {}

  std::unique_ptr<Model> copy() const override { return std::make_unique<QuadricModel>(*this); }
  int size() const override { return 10; }
  std::unique_ptr<Mirror> mirror() const override { return std::make_unique<Quadric>(quadric_); }

  // From the conditions of the closest point, y - x + l g(y) = 0 and f(y) = 0, by the coefficients.
  bool image(const Vector3& x, Vector3& image, Jacobian& derivatives) const override {
    const Vector3 y = quadric_.foot(x);
    if (!y.allFinite()) return false;
    image = 2 * y - x;
    const Vector3 g = quadric_.gradient(y);
    const double squared = g.squaredNorm();
    if (!(squared > 0)) return false;
    const double l = g.dot(x - y) / squared;
    Matrix4 matrix = Matrix4::Zero();
    matrix.topLeftCorner<3, 3>() = Matrix3::Identity() + 2 * l * quadric_.matrix();
    matrix.topRightCorner<3, 1>() = g;
    matrix.bottomLeftCorner<1, 3>() = g.transpose();
    Eigen::Matrix<double, 4, 10> right;
    right.topRows<3>() = -l * slopes(y);
    right.bottomRows<1>() = -monomials(y).transpose();
    derivatives = 2 * matrix.partialPivLu().solve(right).topRows<3>();
    return derivatives.allFinite();
  }

  void step(const Eigen::VectorXd& by) override {
    q_ += by;
    q_ /= q_.norm();
    quadric_ = quadric_from(q_);
  }

 private:
  Coefficients q_;
  Quadric quadric_;
};

}  // namespace

// f = 0 and grad f = n at the feet, by least squares: linear in the coefficients.
std::unique_ptr<Model> quadric_model(const GrownSurface& surface) {
  if (surface.carried.size() < 10) return nullptr;
  Eigen::Matrix<double, 10, 10> matrix = Eigen::Matrix<double, 10, 10>::Zero();
  Coefficients right = Coefficients::Zero();
  constexpr double slope_weight = 0.01;
  for (const Carried& c : surface.carried) {
    const Coefficients m = monomials(c.foot);
    const Eigen::Matrix<double, 3, 10> s = slopes(c.foot);
    matrix += m * m.transpose() + slope_weight * s.transpose() * s;
    right += slope_weight * s.transpose() * c.normal;
  }
  matrix.diagonal().array() += 1e-9 * matrix.trace();
  const Coefficients q = solved(matrix, right);
  if (!q.allFinite() || !(q.head<9>().norm() > 0)) return nullptr;
  return std::make_unique<QuadricModel>(q / q.norm());
}

}  // namespace symsurf::perpendicular
