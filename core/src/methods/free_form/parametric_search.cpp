#include "methods/free_form/parametric_search.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "base/math.h"
#include "base/semidefinite_solve.h"

namespace symsurf::perpendicular {

namespace {

constexpr int rounds = 12, steps_a_round = 3;

struct System {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;
  double cost = 0;
};

double tukey_cost(double u) {
  const double inside = 1 - u * u;
  return u >= 1 ? 1 : 1 - inside * inside * inside;
}

// Misses across the partner's surface count, along it only where partners are exact.
System system(const SearchCloud& cloud, const GrownSurface& surface, const Model& model,
              double scale) {
  System s{Eigen::MatrixXd::Zero(model.size(), model.size()), Eigen::VectorXd::Zero(model.size())};
  const double along = surface.exact ? 1 : 0.08;
  Model::Jacobian jacobian(3, model.size());
  cloud.context.check();
  for (std::size_t k = 0; k < surface.points.size(); ++k) {
    Vector3 image;
    if (!model.image(cloud.point(surface.points[k]), image, jacobian)) continue;
    const Vector3 n = surface.carried[k].partner_normal;
    const Matrix3 metric = along * Matrix3::Identity() + (1 - along) * n * n.transpose();
    const Vector3 miss = metric * (cloud.point(surface.partners[k]) - image);
    const double u = miss.norm() / (4.7 * scale);
    s.cost += tukey_cost(u);
    if (u >= 1) continue;
    const double weight = (1 - u * u) * (1 - u * u);
    const Model::Jacobian rows = metric * jacobian;
    s.matrix.noalias() += weight * rows.transpose() * rows;
    s.right.noalias() += weight * rows.transpose() * miss;
  }
  return s;
}

double scale_of(const SearchCloud& cloud, const GrownSurface& surface) {
  std::vector<double> misses;
  for (const Carried& c : surface.carried)
    misses.push_back(surface.exact ? c.miss.norm() : std::abs(c.miss.dot(c.partner_normal)));
  return std::max(1.5 * median(std::move(misses)), 0.02 * cloud.spacing);
}

void improve(const SearchCloud& cloud, const GrownSurface& surface, std::unique_ptr<Model>& model) {
  const double scale = scale_of(cloud, surface);
  double damping = 1e-9;
  System here = system(cloud, surface, *model, scale);
  for (int k = 0; k < steps_a_round; ++k) {
    Eigen::MatrixXd damped = here.matrix;
    damped.diagonal().array() += damping * here.matrix.trace() + 1e-300;
    const Eigen::VectorXd by = solved(damped, here.right);
    if (!by.allFinite()) return;
    std::unique_ptr<Model> next = model->copy();
    next->step(by);
    System there = system(cloud, surface, *next, scale);
    if (there.cost > here.cost) {
      damping *= 1e3;
      continue;
    }
    model = std::move(next);
    here = std::move(there);
  }
}

}  // namespace

std::unique_ptr<Mirror> fit(const SearchCloud& cloud, std::unique_ptr<Model> model,
                            GrownSurface& surface) {
  if (!model) return nullptr;
  surface.mirror = nullptr;
  std::unique_ptr<Mirror> mirror;
  for (int round = 0; round <= rounds; ++round) {
    mirror = model->mirror();
    if (!mirror) return nullptr;
    match(
        cloud,
        [&](const Vector3& x, Vector3& foot, Vector3& normal) {
          foot = mirror->foot(x);
          const double distance = mirror->signed_distance(x);
          if (!foot.allFinite() || distance == 0) return false;
          normal = (x - foot) / distance;
          return true;
        },
        surface);
    if (static_cast<int>(surface.points.size()) < 2 * model->size()) return nullptr;
    if (round < rounds) improve(cloud, surface, model);
  }
  surface.support = support(cloud, surface);
  return mirror;
}

}  // namespace symsurf::perpendicular
