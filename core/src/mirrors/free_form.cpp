#include <symsurf/errors.h>
#include <symsurf/free_form.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <string>

#include "base/math.h"
#include "mirrors/free_form_blend.h"
#include "mirrors/surface_net.h"

namespace symsurf {

namespace {

constexpr double full_precision = 1e-14;

void require_valid(const std::vector<Patch>& patches) {
  if (patches.empty()) throw InvalidInput("a free-form mirror needs at least one patch");
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const Patch& p = patches[i];
    const bool finite = p.centre.allFinite() && p.frame.allFinite() && p.height.allFinite();
    if (!finite || !(p.radius > 0) || !std::isfinite(p.radius) || !p.frame.isUnitary(1e-6))
      throw InvalidInput("patch " + std::to_string(i) +
                         " needs finite numbers, an orthonormal frame and a radius above 0");
  }
}

}  // namespace

FreeForm::FreeForm(std::vector<Patch> patches) {
  require_valid(patches);
  blend_ = std::make_shared<const Blend>(std::move(patches));
}

const std::vector<Patch>& FreeForm::patches() const { return blend_->patches(); }

bool FreeForm::foot(const Vector3& x, double precision, Vector3& foot, Vector3& normal) const {
  return blend_->closest(x, precision, foot, normal);
}

Vector3 FreeForm::foot(const Vector3& x) const {
  Vector3 y, normal;
  return blend_->closest(x, full_precision, y, normal) ? y : no_point();
}

double FreeForm::signed_distance(const Vector3& x) const {
  Vector3 y, normal;
  return blend_->closest(x, full_precision, y, normal) ? normal.dot(x - y)
                                                       : std::numeric_limits<double>::quiet_NaN();
}

Values FreeForm::numbers() const {
  const Index count = static_cast<Index>(patches().size());
  Eigen::MatrixXd centres(count, 3), tangents(count, 3), normals(count, 3), heights(count, 6),
      radii(count, 1);
  for (Index i = 0; i < count; ++i) {
    const Patch& p = patches()[i];
    centres.row(i) = p.centre.transpose();
    tangents.row(i) = p.frame.row(0);
    normals.row(i) = p.frame.row(2);
    heights.row(i) = p.height.transpose();
    radii(i, 0) = p.radius;
  }
  return {{"centres", centres},
          {"tangents", tangents},
          {"normals", normals},
          {"heights", heights},
          {"radii", radii}};
}

std::unique_ptr<Mirror> FreeForm::transformed(double scale, const Matrix3& rotation,
                                              const Vector3& translation) const {
  std::vector<Patch> moved = patches();
  for (Patch& p : moved) {
    p.centre = scale * (rotation * p.centre) + translation;
    p.frame = p.frame * rotation.transpose();
    p.height[0] *= scale;
    p.height.tail<3>() /= scale;
    p.radius *= scale;
  }
  return std::make_unique<FreeForm>(std::move(moved));
}

// Surface nets over a grid along the patches' principal axes, so that it turns with the mirror.
Mesh FreeForm::mesh_over(PointsView object, int resolution) const {
  const Points feet = finite_rows(project(object));
  if (feet.rows() == 0) return {};
  return surface_net(
      feet, resolution, [this](const Vector3& x) { return blend_->value(x); },
      [this](const Vector3& x) { return foot(x); });
}

}  // namespace symsurf
