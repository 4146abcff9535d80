#pragma once

#include <symsurf/mirrors.h>

#include <memory>
#include <optional>
#include <vector>

#include "methods/free_form/height_spline.h"
#include "methods/free_form/search_cloud.h"

namespace symsurf::perpendicular {

/// A mirror that starts as a plane and is bent, step by step, until the points' images lie on the
/// cloud.
class BentPlane {
 public:
  /// Through a point of the plane, as wide as the cloud. The cloud must outlive it.
  BentPlane(const SearchCloud& cloud, const Vector3& point, const Vector3& normal);

  /// One Gauss-Newton step on the points of every `stride`-th position of the tree's order: images
  /// are drawn to the tangent planes of their partners, against the variation of curvature times
  /// `stiffness`. Partners farther than `tolerance` weigh little.
  void step(double tolerance, double stiffness, Index stride);

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
    HeightSpline::Weights at;
    HeightSpline::Weights::Row row;
    double miss, weight;
  };

  Vector3 to_frame(const Vector3& x) const { return axes_ * (x - origin_); }
  Foot foot(const Vector3& x, HeightSpline::At from) const;
  Neighbour partner_of(const Vector3& image, const Vector3& normal, double tolerance, double reach);
  std::optional<Equation> equation_of(Index i, double tolerance);

  const SearchCloud* cloud_;
  Vector3 origin_;
  Matrix3 axes_;  // rows: two along the plane and its normal
  HeightSpline heights_;
  Eigen::MatrixXd energy_;              // theirs
  std::vector<HeightSpline::At> feet_;  // of the points, as they were last
  double support_ = 0;
  std::vector<Neighbour> near_;  // of the last image
};

}  // namespace symsurf::perpendicular
