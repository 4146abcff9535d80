#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/math.h"
#include "cloud/point_tree.h"
#include "mirrors/mirror_mesh.h"

namespace symsurf {

// The implicit function of a free-form mirror.
struct FreeForm::Blend {
  explicit Blend(std::vector<Patch> given);

  const std::vector<Patch> patches;

  // The blended height of x; where no patch reaches, the nearest one's.
  double value(const Vector3& x) const;

  // The surface's point closest to x; `precision` is relative to the patches.
  std::optional<Foot> closest(const Vector3& x, double precision) const;

  // Second over first derivatives at a point of the surface.
  Matrix3 bend(const Vector3& foot) const;

 private:
  struct Jet {
    double value;
    Vector3 gradient;
    Matrix3 hessian;
  };
  // These take and give coordinates from origin_.
  // The patches that reach a position within `slack` of x.
  void around(const Vector3& x, double slack, std::vector<std::int32_t>& patches) const;
  std::optional<Jet> jet(const Vector3& x, const std::vector<std::int32_t>& patches) const;

  // A patch's height above its centre + d as a quadratic in d: slope . d + d . bend d / 2 - height.
  struct Piece {
    Vector3 centre;
    double per_squared_radius;
    double height;
    Vector3 slope;
    Matrix3 bend;

    double above(const Vector3& d) const { return d.dot(slope + 0.5 * (bend * d)) - height; }
  };

  std::vector<Piece> pieces_;
  double reach_ = 0;  // the largest radius
  Vector3 origin_;    // all is reckoned from here: as exact wherever the mirror lies
  PointTree tree_;    // of the centres
};

namespace {

Points centres_of(const std::vector<Patch>& patches) {
  Points centres(static_cast<Index>(patches.size()), 3);
  for (Index i = 0; i < centres.rows(); ++i) centres.row(i) = patches[i].centre;
  return centres;
}

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

FreeForm::Blend::Blend(std::vector<Patch> given)
    : patches(std::move(given)),
      origin_((centres_of(patches) / static_cast<double>(patches.size())).colwise().sum()),
      tree_(Points(centres_of(patches).rowwise() - origin_.transpose())) {
  for (const Patch& p : patches) {
    reach_ = std::max(reach_, p.radius);
    Matrix3 bend = Matrix3::Zero();
    bend(0, 0) = 2 * p.height[3];
    bend(0, 1) = bend(1, 0) = p.height[4];
    bend(1, 1) = 2 * p.height[5];
    pieces_.push_back({p.centre - origin_, 1 / (p.radius * p.radius), p.height[0],
                       p.frame.transpose() * Vector3(-p.height[1], -p.height[2], 1),
                       -p.frame.transpose() * bend * p.frame});
  }
}

void FreeForm::Blend::around(const Vector3& x, double slack,
                             std::vector<std::int32_t>& patches) const {
  patches.clear();
  tree_.within(x, reach_ + slack, [&](Index i, double squared) {
    const double farthest = this->patches[i].radius + slack;
    if (squared < farthest * farthest) patches.push_back(static_cast<std::int32_t>(i));
  });
}

std::optional<FreeForm::Blend::Jet> FreeForm::Blend::jet(
    const Vector3& x, const std::vector<std::int32_t>& patches) const {
  double weights = 0, value = 0, weights_bend = 0;
  Vector3 slope = Vector3::Zero(), weights_slope = Vector3::Zero(), value_slope = Vector3::Zero();
  Matrix3 hessian = Matrix3::Zero(), mixed = Matrix3::Zero();
  for (const std::int32_t i : patches) {
    const Piece& p = pieces_[i];
    const Vector3 d = x - p.centre;
    const double inside = 1 - d.squaredNorm() * p.per_squared_radius;
    if (inside <= 0) continue;
    const double weight = inside * inside * inside;
    const Vector3 bent = p.bend * d;
    const double q = d.dot(p.slope + 0.5 * bent) - p.height;
    const Vector3 g = p.slope + bent;
    const double fall = -6 * inside * inside * p.per_squared_radius;
    const Vector3 weight_slope = fall * d;
    weights += weight;
    value += weight * q;
    slope += weight * g;
    weights_slope += weight_slope;
    value_slope += weight_slope * q;
    hessian += weight * p.bend;
    // Half of each: the sum with its transpose makes up the rest.
    const double weight_bend = 12 * inside * p.per_squared_radius * p.per_squared_radius;
    mixed += d * (fall * g + weight_bend * q * d).transpose();
    weights_bend += fall * q;
  }
  if (!(weights > 0)) return std::nullopt;
  Jet jet;
  jet.value = value / weights;
  jet.gradient = (slope + value_slope - jet.value * weights_slope) / weights;
  mixed -= weights_slope * jet.gradient.transpose();
  hessian.diagonal().array() += weights_bend;
  jet.hessian = (hessian + mixed + mixed.transpose()) / weights;
  return jet;
}

double FreeForm::Blend::value(const Vector3& x) const {
  std::vector<std::int32_t> patches;
  const Vector3 from_origin = x - origin_;
  around(from_origin, 0, patches);
  if (const std::optional<Jet> here = jet(from_origin, patches)) return here->value;
  const Neighbour nearest = tree_.nearest(from_origin);
  if (nearest.index < 0) return std::numeric_limits<double>::quiet_NaN();  // at infinity
  const Piece& piece = pieces_[nearest.index];
  return piece.above(from_origin - piece.centre);
}

// Newton's method on the conditions of the closest point, x - y = lambda g and f(y) = 0. The
// hessian leaves out what vanishes with f.
std::optional<Foot> FreeForm::Blend::closest(const Vector3& x, double precision) const {
  const Vector3 from_origin = x - origin_;
  const Neighbour start = tree_.nearest(from_origin);
  if (start.index < 0) return std::nullopt;  // at infinity
  Vector3 y = pieces_[start.index].centre, middle = y;
  const int most_steps = precision < 1e-6 ? 20 : 10;
  const double longest = 0.5 * reach_, enough = precision * (reach_ + (from_origin - y).norm());
  static thread_local std::vector<std::int32_t> patches;
  const double slack = 0.2 * reach_;
  around(middle, slack, patches);
  double lambda = 0;
  for (int step = 0; step < most_steps; ++step) {
    if ((y - middle).squaredNorm() > slack * slack) around(middle = y, slack, patches);
    const std::optional<Jet> here = jet(y, patches);
    if (!here) break;
    const Vector3 &g = here->gradient, gap = from_origin - y;
    const double squared = g.squaredNorm();
    if (!(squared > 0)) break;
    if (step == 0) lambda = g.dot(gap) / squared;
    Matrix3 a = Matrix3::Identity() + lambda * here->hessian;
    // Beyond the centre of curvature the step would climb: walk along the tangent plane instead.
    const double minor = a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0);
    if (!(a(0, 0) > 0 && minor > 0 && a.determinant() > 0)) a.setIdentity();
    const Matrix3 inverse = a.inverse();
    const Vector3 ag = inverse * g;
    lambda = (ag.dot(gap) + here->value) / ag.dot(g);
    Vector3 move = inverse * (gap - lambda * g);
    const double length = move.norm();
    if (!std::isfinite(length)) break;
    if (length > longest) move *= longest / length;
    y += move;
    if (length <= enough || (step > 12 && length <= 1e3 * enough)) {
      const Vector3 foot = y + origin_, normal = g.normalized();
      return Foot{foot, normal, normal.dot(x - foot)};
    }
  }
  return std::nullopt;
}

Matrix3 FreeForm::Blend::bend(const Vector3& foot) const {
  std::vector<std::int32_t> patches;
  const Vector3 from_origin = foot - origin_;
  around(from_origin, 0, patches);
  const std::optional<Jet> here = jet(from_origin, patches);
  return here ? Matrix3(here->hessian / here->gradient.norm()) : Matrix3::Constant(NAN);
}

FreeForm::FreeForm(std::vector<Patch> patches) {
  require_valid(patches);
  blend_ = std::make_shared<const Blend>(std::move(patches));
}

const std::vector<Patch>& FreeForm::patches() const { return blend_->patches; }

bool FreeForm::foot(const Vector3& x, double precision, Vector3& foot, Vector3& normal) const {
  const std::optional<Foot> found = blend_->closest(x, precision);
  if (!found) return false;
  foot = found->point;
  normal = found->normal;
  return true;
}

std::optional<Foot> FreeForm::at(const Vector3& x) const {
  constexpr double full_precision = 1e-14;
  return blend_->closest(x, full_precision);
}

Matrix3 FreeForm::shape_operator(const Foot& foot) const {
  const Matrix3 tangent = across(foot.normal);
  return tangent * blend_->bend(foot.point) * tangent;
}

Values FreeForm::numbers() const {
  const Index count = static_cast<Index>(patches().size());
  Eigen::MatrixXd centres(count, 3), tangents = centres, normals = centres, heights(count, 6),
                                     radii(count, 1);
  for (Index i = 0; i < count; ++i) {
    const Patch& p = patches()[i];
    centres.row(i) = p.centre;
    tangents.row(i) = p.frame.row(0);
    normals.row(i) = p.frame.row(2);
    heights.row(i) = p.height;
    radii(i) = p.radius;
  }
  return {{"centres", centres},
          {"tangents", tangents},
          {"normals", normals},
          {"heights", heights},
          {"radii", radii}};
}

std::unique_ptr<Mirror> FreeForm::moved(const Motion& by) const {
  std::vector<Patch> patches = this->patches();
  for (Patch& p : patches) {
    p.centre = by(p.centre);
    p.frame *= by.rotation.transpose();
    p.frame.row(1) = p.frame.row(2).cross(p.frame.row(0));  // what comes back from two rows
    p.height[0] *= by.scale;
    p.height.tail<3>() /= by.scale;
    p.radius *= by.scale;
  }
  return std::make_unique<FreeForm>(std::move(patches));
}

// Surface nets over a grid along the patches' principal axes, so that it turns with the mirror.
Mesh FreeForm::mesh_over(const std::vector<Foot>& feet, int resolution,
                         const Context& context) const {
  return surface_net(
      *this, feet, resolution, [this](const Vector3& x) { return blend_->value(x); }, context);
}

}  // namespace symsurf
