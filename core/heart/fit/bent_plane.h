#pragma once

#include <symsurf/context.h>
#include <symsurf/mirrors.h>
#include <symsurf/points.h>

#include <array>
#include <memory>
#include <vector>

#include "cloud/surface_points.h"

namespace symsurf {

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

/// A mirror that starts as a plane and is bent, step by step, until the points' images lie on the
/// cloud.
class BentPlane {
 public:
  /// Through a point of the plane, as wide as the cloud. The cloud must outlive it.
  BentPlane(const SurfacePoints& cloud, const Vector3& point, const Vector3& normal);

  /// One Gauss-Newton step on the points of every `stride`-th position of the tree's order: images
  /// are drawn to the tangent planes of their partners, against the variation of curvature times
  /// `stiffness`. Partners farther than `tolerance` weigh little.
  void step(double tolerance, double stiffness, Index stride, const Context& context);

  void subdivide();

  /// The share of those points whose images fell on the cloud, as it was before the last step.
  double support() const { return support_; }

  Vector3 image(const Vector3& x) const;

  /// The mirror near the feet of the points.
  std::shared_ptr<const FreeForm> free_form() const;

 private:
  // The foot of a point, in the plane's frame.
  struct Foot {
    HeightSpline::At at;
    Vector3 position, normal;
    double slant;  // one over the cosine between the mirror's normal and the plane's
  };

  // Of least squares: how far a point's image is off its partner's tangent plane, and by how much
  // each coefficient that reaches the foot moves it.
  struct Equation {
    std::array<Index, HeightSpline::Weights::count> coefficients;
    HeightSpline::Weights::Row row;
    double miss = 0, weight = 0;
  };

  Vector3 to_frame(const Vector3& x) const { return axes_ * (x - origin_); }
  Foot foot(const Vector3& x, HeightSpline::At from) const;
  Neighbour partner_of(const Vector3& image, const Vector3& normal, double tolerance,
                       double reach) const;
  // Of a point, whose foot it moves; without weight where its image has no partner.
  Equation equation_of(Index i, double tolerance);

  const SurfacePoints* cloud_;
  Vector3 origin_;
  Matrix3 axes_;  // rows: two along the plane and its normal
  HeightSpline heights_;
  Eigen::MatrixXd energy_;              // theirs
  std::vector<HeightSpline::At> feet_;  // of the points, as they were last
  double support_ = 0;
};

}  // namespace symsurf
