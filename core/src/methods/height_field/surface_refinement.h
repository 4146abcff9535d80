#pragma once

#include <optional>

#include "cloud/surface_points.h"
#include "methods/height_field/field_search.h"
#include "methods/height_field/height_regression.h"
#include "methods/height_field/mid_surface.h"

namespace symsurf {

/// Where the surfaces of a cloud end. A mirror maps rims onto rims, and where no point has an exact
/// partner that is what determines its direction: half-way between two surfaces there is a surface
/// along any direction.
///
/// A point near a rim has its neighbours on one side of it: their mean offset, as a share of their
/// reach, grows from 0 inside to 4/(3 pi) on a straight rim.
class SurfaceRims {
 public:
  explicit SurfaceRims(const SurfacePoints& cloud);

  /// A piece of rim as it looks along a direction.
  struct Rim {
    Eigen::Vector2d inwards;  ///< unit, across the direction
    double distance;          ///< of the point from it
    double reach;             ///< beyond which a rim is not seen
  };
  /// The rim near point i; false where there is none, or where it points along the direction.
  bool seen_across(Index i, const Eigen::Matrix<double, 3, 2>& across, Rim& rim) const;

 private:
  const SurfacePoints& cloud_;
  Points lean_;  // mean offset of the neighbours within the surface, as a share of their reach
  Eigen::VectorXd reach_;  // of the neighbours
};

/// Least squares for the turn of a direction that carries rims onto rims. Surfaces of different
/// density end, as far as their points show, differently far inside their rims: one common
/// difference is an unknown too. A prior keeps the direction near where the search began, for
/// surfaces so close that turning moves no rim.
class RimAlignment {
 public:
  RimAlignment(const SurfaceRims& rims, const Eigen::Matrix<double, 3, 2>& across)
      : rims_(rims), across_(across) {}

  /// A point whose image lies by `aside` away from its partner, and moves by `arm` times a turn.
  void add(Index point, Index partner, const Eigen::Vector2d& aside, double arm, double weight);

  /// From the present direction, the start of the search as it lies across it given.
  Eigen::Vector2d turn(const Eigen::Vector2d& start) const;

 private:
  const SurfaceRims& rims_;
  Eigen::Matrix<double, 3, 2> across_;
  Matrix3 normal_ = Matrix3::Zero();  // of the turn and the common difference
  Vector3 right_ = Vector3::Zero();
};

/// Mirror, match, fit again: images over the estimate meet the surfaces on the other side, half
/// their distance along the direction is what the surface is wrong by there. Where partners are
/// known, what remains across determines how the direction turns; where not, the rims do.
class SurfaceRefinement {
 public:
  SurfaceRefinement(const SurfacePoints& cloud, const SurfacePatches& patches,
                    const Context& context);

  /// Starts from the surface that MidSurface votes for, where `scatter` (infinity: unknown) is that
  /// of partners across the direction.
  FieldEstimate operator()(const Vector3& direction, double scatter, int rounds);

 private:
  struct Matches {
    std::vector<HeightObservation> observations;
    Eigen::Vector2d turn = Eigen::Vector2d::Zero();  // that the matches ask of the direction
    double support = 0;
  };
  Matches matches(const FieldEstimate& estimate) const;
  void refit(FieldEstimate& estimate, Matches found) const;
  FieldEstimate voted(const Vector3& direction, double scatter);

  const SurfacePoints& cloud_;
  const SurfacePatches& patches_;
  const Context context_;
  std::optional<SurfaceRims> rims_;  // where no partners determine the direction
  Vector3 start_ = Vector3::Zero();
  MidSurface votes_;
};

}  // namespace symsurf
