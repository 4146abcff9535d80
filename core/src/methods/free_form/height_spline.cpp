#include "methods/free_form/height_spline.h"

#include <algorithm>
#include <cmath>

namespace symsurf::perpendicular {

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

}  // namespace symsurf::perpendicular
