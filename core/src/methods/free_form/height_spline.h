#pragma once

#include <symsurf/points.h>

#include <array>

namespace symsurf::perpendicular {

/// Heights over a rectangle of a plane: a uniform bicubic B-spline (de Boor, "A Practical Guide to
/// Splines").
class HeightSpline {
 public:
  using At = Eigen::Vector2d;

  /// The height and its derivatives along the plane.
  struct Jet {
    double h, u, v, uu, uv, vv;
  };

  /// What the coefficients of the splines that reach a position weigh there: in the height, in its
  /// slopes and in its second derivatives.
  struct Weights {
    static constexpr int count = 16;
    using Row = Eigen::Matrix<double, 1, count>;
    std::array<Index, count> index;
    Row h, u, v, uu, uv, vv;
  };

  /// Flat, of square cells that cover the rectangle.
  HeightSpline(const At& low, const At& high, double cell);

  /// The same heights over cells of half the length (Lane and Riesenfeld 1980).
  HeightSpline subdivided() const;

  /// The position nearest to this that has heights.
  At clamped(const At& at) const { return at.cwiseMax(low_).cwiseMin(high()); }

  const At& low() const { return low_; }
  At high() const { return low_ + cell_ * cells_.cast<double>(); }

  Weights weights(const At& at) const;
  Jet jet(const At& at) const;

  Index size() const { return coefficients_.size(); }
  void step(const Eigen::VectorXd& by) { coefficients_ += by; }
  const Eigen::VectorXd& coefficients() const { return coefficients_; }

  /// E with c' E c the mean over the rectangle of h_uuu^2 + 3 h_uuv^2 + 3 h_uvv^2 + h_vvv^2, by
  /// Gauss's rule of two points a side in each cell: how much the curvature varies (Moreton and
  /// Sequin 1992, "Functional optimization for fair surface design").
  Eigen::MatrixXd curvature_variation() const;

 private:
  struct Cell {
    std::array<Index, Weights::count> index;
    At along;  // 0 to 1
  };

  HeightSpline(const At& low, double cell, const Eigen::Vector2i& cells);
  Cell cell_at(const At& at) const;

  At low_;
  double cell_;
  Eigen::Vector2i cells_;
  Eigen::VectorXd coefficients_;  // v fastest, three more than cells along each side
};

}  // namespace symsurf::perpendicular
