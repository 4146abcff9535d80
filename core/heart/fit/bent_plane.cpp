#include "fit/bent_plane.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"

namespace symsurf {

namespace {

constexpr int spline_support = 4;  // coefficients that are not 0 along a side

// The cubic B-splines that overlap a cell, and their derivatives, at t of its length, 0 to 1.
struct Cubics {
  std::array<double, spline_support> value, first, second, third;

  Cubics(double t, double cell) {
    const double s = 1 - t;
    value = {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6,
             (3 * s * s * s - 6 * s * s + 4) / 6, t * t * t / 6};
    first = {-s * s / 2, (3 * t * t - 4 * t) / 2, (4 * s - 3 * s * s) / 2, t * t / 2};
    second = {s, 3 * t - 2, 3 * s - 2, t};
    third = {-1, 3, -3, 1};
    for (double& f : first) f /= cell;
    for (double& f : second) f /= cell * cell;
    for (double& f : third) f /= cell * cell * cell;
  }
};

HeightSpline::Weights::Row product(const std::array<double, spline_support>& u,
                                   const std::array<double, spline_support>& v) {
  HeightSpline::Weights::Row row;
  for (int i = 0, k = 0; i < spline_support; ++i)
    for (int j = 0; j < spline_support; ++j, ++k) row[k] = u[i] * v[j];
  return row;
}

// The refinement mask of cubic splines, (1 4 6 4 1) / 8, along the columns.
Eigen::MatrixXd subdivided_columns(const Eigen::MatrixXd& c) {
  Eigen::MatrixXd finer(2 * c.rows() - 3, c.cols());
  for (Index k = 0; k < finer.rows(); ++k) {
    const Index i = k / 2;
    if (k % 2)
      finer.row(k) = (c.row(i) + 6 * c.row(i + 1) + c.row(i + 2)) / 8;
    else
      finer.row(k) = (c.row(i) + c.row(i + 1)) / 2;
  }
  return finer;
}

}  // namespace

HeightSpline::HeightSpline(const At& low, double cell, const Eigen::Vector2i& cells)
    : low_(low),
      cell_(cell),
      cells_(cells),
      coefficients_(
          Eigen::VectorXd::Zero((cells.array().cast<Index>() + (spline_support - 1)).prod())) {}

HeightSpline::HeightSpline(const At& low, const At& high, double cell)
    : HeightSpline(low, cell, ((high - low) / cell).array().ceil().max(1).cast<int>().matrix()) {
  low_ = (low + high - cell_ * cells_.cast<double>()) / 2;
}

HeightSpline HeightSpline::subdivided() const {
  HeightSpline finer(low_, cell_ / 2, 2 * cells_);
  const Eigen::MatrixXd c = Eigen::MatrixXd::Map(
      coefficients_.data(), cells_.y() + spline_support - 1, cells_.x() + spline_support - 1);
  const Eigen::MatrixXd both = subdivided_columns(subdivided_columns(c).transpose()).transpose();
  finer.coefficients_ = both.reshaped();
  return finer;
}

HeightSpline::Cell HeightSpline::cell_at(const At& at) const {
  const At position = (at - low_) / cell_;
  const Eigen::Vector2i cell =
      position.array().floor().cast<int>().max(0).min(cells_.array() - 1).matrix();
  Cell found{{}, position - cell.cast<double>()};
  for (int i = 0, k = 0; i < spline_support; ++i)
    for (int j = 0; j < spline_support; ++j, ++k)
      found.index[k] =
          static_cast<Index>(cell.x() + i) * (cells_.y() + spline_support - 1) + cell.y() + j;
  return found;
}

HeightSpline::Weights HeightSpline::weights(const At& at) const {
  const Cell cell = cell_at(at);
  const Cubics u(cell.along.x(), cell_), v(cell.along.y(), cell_);
  return {cell.index,
          product(u.value, v.value),
          product(u.first, v.value),
          product(u.value, v.first),
          product(u.second, v.value),
          product(u.first, v.first),
          product(u.value, v.second)};
}

HeightSpline::Jet HeightSpline::jet(const At& at) const {
  const Weights w = weights(at);
  Weights::Row c;
  for (int k = 0; k < Weights::count; ++k) c[k] = coefficients_[w.index[k]];
  return {w.h.dot(c), w.u.dot(c), w.v.dot(c), w.uu.dot(c), w.uv.dot(c), w.vv.dot(c)};
}

Eigen::MatrixXd HeightSpline::curvature_variation() const {
  const std::array<double, 2> gauss{0.5 - std::sqrt(3.0) / 6, 0.5 + std::sqrt(3.0) / 6};
  Eigen::MatrixXd energy = Eigen::MatrixXd::Zero(size(), size());
  for (int x = 0; x < cells_.x(); ++x)
    for (int y = 0; y < cells_.y(); ++y)
      for (const double s : gauss)
        for (const double t : gauss) {
          const Cell cell = cell_at(low_ + cell_ * At(x + s, y + t));
          const Cubics u(s, cell_), v(t, cell_);
          const Weights::Row uuu = product(u.third, v.value), uuv = product(u.second, v.first),
                             uvv = product(u.first, v.second), vvv = product(u.value, v.third);
          const Eigen::Matrix<double, Weights::count, Weights::count> products =
              uuu.transpose() * uuu + 3 * uuv.transpose() * uuv + 3 * uvv.transpose() * uvv +
              vvv.transpose() * vvv;
          for (int i = 0; i < Weights::count; ++i)
            for (int j = 0; j < Weights::count; ++j)
              energy(cell.index[i], cell.index[j]) += products(i, j);
        }
  return energy / (4.0 * cells_.prod());
}

namespace {

using At = HeightSpline::At;
using Weights = HeightSpline::Weights;

constexpr double first_cell = 0.5, margin = 0.03;  // diagonals

// (I + g g')^-1 x: Sherman and Morrison's formula, which steep slopes g cannot make singular.
At along_surface(const At& g, const At& x) { return x - g.dot(x) / (1 + g.squaredNorm()) * g; }

// The box of the cloud along the plane.
HeightSpline flat_over(const SurfacePoints& cloud, const Vector3& origin, const Matrix3& axes) {
  At low = At::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (Index i = 0; i < cloud.size(); ++i) {
    const At at = (axes * (cloud.point(i) - origin)).head<2>();
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  return {low - At::Constant(margin), high + At::Constant(margin), first_cell};
}

// The plane's frame turned so that the cloud extends most along its first row: fewest cells.
Matrix3 axes_along(const SurfacePoints& cloud, const Vector3& origin, const Vector3& normal) {
  const Matrix3 frame = frame_of(normal);
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (Index i = 0; i < cloud.size(); ++i) {
    const At at = (frame * (cloud.point(i) - origin)).head<2>();
    spread += at * at.transpose();
  }
  const Eigen::Matrix2d turn = eigen_of(spread).vectors;
  Matrix3 axes;
  axes.row(0) = turn.col(1).transpose() * frame.topRows<2>();
  axes.row(2) = frame.row(2);
  axes.row(1) = axes.row(2).cross(axes.row(0));
  return axes;
}

}  // namespace

BentPlane::BentPlane(const SurfacePoints& cloud, const Vector3& point, const Vector3& normal)
    : cloud_(&cloud),
      origin_(point),
      axes_(axes_along(cloud, point, normal)),
      heights_(flat_over(cloud, point, axes_)),
      energy_(heights_.curvature_variation()),
      feet_(cloud.size()) {
  for (Index i = 0; i < cloud.size(); ++i) feet_[i] = to_frame(cloud.point(i)).head<2>();
}

// Newton's steps on the squared distance; where it is not convex, Gauss-Newton's.
BentPlane::Foot BentPlane::foot(const Vector3& x, At at) const {
  constexpr int most_steps = 8;
  constexpr double precision = 1e-7, longest_step = 0.1, least_determinant = 0.2;
  for (int k = 0; k < most_steps; ++k) {
    const HeightSpline::Jet jet = heights_.jet(at);
    const double above = jet.h - x.z();
    const At slope(jet.u, jet.v), gradient = at - x.head<2>() + above * slope;
    Eigen::Matrix2d curved;
    curved << jet.uu, jet.uv, jet.uv, jet.vv;
    curved = Eigen::Matrix2d::Identity() + slope * slope.transpose() + above * curved;
    const bool convex = curved.determinant() > least_determinant && curved.trace() > 0;
    At step = convex ? At(curved.inverse() * gradient) : along_surface(slope, gradient);
    if (step.norm() > longest_step) step *= longest_step / step.norm();
    const At next = heights_.clamped(at - step);
    const bool found = (next - at).norm() < precision;
    at = next;
    if (found) break;
  }
  const HeightSpline::Jet jet = heights_.jet(at);
  const Vector3 upwards(-jet.u, -jet.v, 1);
  const double slant = upwards.norm();
  return {at, Vector3(at.x(), at.y(), jet.h), upwards / slant, slant};
}

// Of the nearest points the one whose normal fits as well: across a thin part lies its other side.
Neighbour BentPlane::partner_of(const Vector3& image, const Vector3& normal, double tolerance,
                                double reach) const {
  constexpr Index nearest = 6;
  static thread_local std::vector<Neighbour> near;
  cloud_->tree.nearest(image, std::min(nearest, cloud_->size()), near);
  Neighbour best{-1, 0};
  double least = infinity;
  for (const Neighbour& other : near) {
    if (other.squared_distance > reach * reach) break;
    const double cosine = cloud_->normal(other.index).dot(normal);
    const double cost = other.squared_distance + tolerance * tolerance * (1 - cosine * cosine);
    if (cost >= least) continue;
    least = cost;
    best = other;
  }
  return best;
}

BentPlane::Equation BentPlane::equation_of(Index i, double tolerance) {
  constexpr double farthest = 3;  // tolerances
  constexpr double least_cosine = 0.6;
  const Vector3 x = to_frame(cloud_->point(i));
  const Foot foot = this->foot(x, feet_[i]);
  feet_[i] = foot.at;
  const double distance = foot.normal.dot(x - foot.position);
  // Near the mirror a point's neighbours are its image's, wherever the mirror is.
  const double moved = std::clamp(std::abs(distance) / (1.5 * cloud_->spacing) - 0.5, 0.0, 1.0);
  if (moved == 0) return {};
  const Vector3 image = x - 2 * distance * foot.normal;
  const double reach = farthest * tolerance;
  const Vector3 normal = axes_ * cloud_->normal(i);
  const Vector3 turned = normal - 2 * foot.normal.dot(normal) * foot.normal;
  const Neighbour near =
      partner_of(axes_.transpose() * image + origin_, axes_.transpose() * turned, tolerance, reach);
  if (near.index < 0) return {};
  const Vector3 partner = axes_ * cloud_->normal(near.index);
  const double cosine = std::abs(partner.dot(turned));
  if (cosine < least_cosine) return {};

  // Raising the mirror by q at the foot moves the image by 2 q n, tilting it by grad q by
  // 2 d grad q.
  const Weights at = heights_.weights(foot.at);
  Equation equation{at.index, {}};
  const At slope = -foot.normal.head<2>() / foot.normal.z();
  const At slopes = along_surface(slope, partner.head<2>() + partner.z() * slope);
  equation.row =
      2 / foot.slant *
      (partner.dot(foot.normal) * at.h + distance * (slopes.x() * at.u + slopes.y() * at.v));
  equation.miss = partner.dot(to_frame(cloud_->point(near.index)) - image);
  const double far = near.squared_distance / (tolerance * tolerance);
  equation.weight = moved * cosine * cosine / ((1 + far) * (1 + far));
  return equation;
}

void BentPlane::step(double tolerance, double stiffness, Index stride, const Context& context) {
  constexpr Index grain = 64;  // points that a thread takes at a time
  std::vector<Equation> equations((cloud_->size() + stride - 1) / stride);
  silent_parallel_for(context, static_cast<Index>(equations.size()), grain,
                      [&](Index begin, Index end) {
                        for (Index k = begin; k < end; ++k)
                          equations[k] = equation_of(cloud_->tree.order()[k * stride], tolerance);
                      });
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(heights_.size(), heights_.size());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(heights_.size());
  double total = 0;
  for (const auto& [index, row, miss, weight] : equations) {
    if (weight == 0) continue;
    total += weight;
    const Eigen::Matrix<double, Weights::count, Weights::count> products =
        weight * row.transpose() * row;
    for (int a = 0; a < Weights::count; ++a) {
      right[index[a]] += weight * miss * row[a];
      for (int b = 0; b < Weights::count; ++b) matrix(index[a], index[b]) += products(a, b);
    }
  }
  support_ = total / static_cast<double>(equations.size());
  if (total == 0) return;
  const Eigen::MatrixXd energy = stiffness * energy_;
  const Eigen::VectorXd change =
      solved(matrix / total + energy, right / total - energy * heights_.coefficients());
  // Normals in the plane of coplanar points hold no height at all.
  if (change.allFinite()) heights_.step(change);
}

void BentPlane::subdivide() {
  heights_ = heights_.subdivided();
  energy_ = heights_.curvature_variation();
}

Vector3 BentPlane::image(const Vector3& x) const {
  const Vector3 inside = to_frame(x);
  const Foot foot = this->foot(inside, inside.head<2>());
  return x - 2 * foot.normal.dot(inside - foot.position) * (axes_.transpose() * foot.normal);
}

// The spline's second-order pieces about the nodes of a grid.
std::shared_ptr<const FreeForm> BentPlane::free_form() const {
  constexpr double apart = 0.02, overlap = 2.2;
  constexpr Index around = 3;  // nodes about each foot
  const At low = heights_.low();
  const Eigen::Vector2i size = ((heights_.high() - low) / apart).array().floor().cast<int>() + 1;
  std::vector<char> wanted(size.cast<Index>().prod(), 0);
  for (Index i = 0; i < cloud_->size(); ++i) {
    const At foot = this->foot(to_frame(cloud_->point(i)), feet_[i]).at;
    const Eigen::Array2i at = ((foot - low) / apart).array().round().cast<int>();
    const Eigen::Array2i from = (at - around).max(0), to = (at + around).min(size.array() - 1);
    for (int x = from.x(); x <= to.x(); ++x)
      for (int y = from.y(); y <= to.y(); ++y) wanted[static_cast<Index>(x) * size.y() + y] = 1;
  }
  std::vector<Patch> patches;
  for (int x = 0; x < size.x(); ++x)
    for (int y = 0; y < size.y(); ++y) {
      if (!wanted[static_cast<Index>(x) * size.y() + y]) continue;
      const At at = low + apart * At(x, y);
      const HeightSpline::Jet jet = heights_.jet(at);
      const Vector3 upwards(-jet.u, -jet.v, 1);
      Patch patch;
      patch.centre = axes_.transpose() * Vector3(at.x(), at.y(), jet.h) + origin_;
      patch.frame = frame_of(axes_.transpose() * upwards.normalized());
      patch.radius = overlap * apart * upwards.norm();
      // Along a tangent the plane's coordinates change as its projection; heights above the tangent
      // plane are those above the plane, less steep.
      const Eigen::Matrix2d along = (patch.frame.topRows<2>() * axes_.transpose()).leftCols<2>();
      Eigen::Matrix2d second;
      second << jet.uu, jet.uv, jet.uv, jet.vv;
      second = along * second * along.transpose() / upwards.norm();
      patch.height << 0, 0, 0, second(0, 0) / 2, second(0, 1), second(1, 1) / 2;
      patches.push_back(patch);
    }
  return std::make_shared<FreeForm>(std::move(patches));
}

}  // namespace symsurf
