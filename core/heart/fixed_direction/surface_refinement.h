#pragma once

#include <symsurf/points.h>

#include <span>
#include <vector>

#include "cloud/point_tree.h"
#include "cloud/surface_points.h"
#include "fixed_direction/fixed_direction.h"
#include "fixed_direction/mid_surface.h"

namespace symsurf {

/// What is known of a surface's height at one position of the plane.
struct HeightObservation {
  Eigen::Vector2d position;
  double height;
  double weight;
};

/// Robust local quadratic regression (loess, Cleveland 1979) of heights over scattered positions.
class HeightRegression {
 public:
  /// The context, which must outlive it, is asked whether to go on.
  HeightRegression(std::vector<HeightObservation> observations, const Context& context);

  /// The positions (rows u, v, anything) with the heights fitted there, each from its `neighbours`
  /// nearest observations, tricube weights; without positions where all of these were rejected.
  Points fitted(const Points& positions, Index neighbours) const;

  /// The largest of the numbers of neighbours offered that predicts left-out observations about as
  /// well as the best does.
  Index best_neighbours(const std::vector<Index>& offered) const;

  /// Positions of observations, as rows for fitted(), no two within `distance`: heights fitted side
  /// by side differ a little, and a surface through them all would be steep between them.
  Points thinned_positions(double distance) const;

 private:
  Points positions() const;
  void nearest(const Eigen::Vector2d& position, Index neighbours,
               std::vector<Neighbour>& near) const;
  /// Height at a position from those near it, but for `left_out`; NaN where all were rejected.
  double height(const Eigen::Vector2d& position, std::span<const Neighbour> near,
                Index left_out) const;

  std::vector<HeightObservation> observations_;
  const Context& context_;
  PointTree tree_;
};

/// The surfaces of a cloud between its points: about each point a quadratic patch over its tangent
/// plane, fitted to its neighbours.
class SurfacePatches {
 public:
  SurfacePatches(const SurfacePoints& cloud, Index neighbours, const Context& context);

  /// How far x must move along the unit direction to lie on the patch about point j; NaN where the
  /// patch and the direction are nearly parallel.
  double along(Index j, const Vector3& x, const Vector3& direction) const;

  const Vector3& normal(Index j) const { return patches_[j].normal; }

 private:
  struct Patch {
    Vector3 centre, first, second, normal;  // orthonormal frame
    Eigen::Matrix<double, 6, 1> height;     // 1, a, b, a², ab, b²
    double reach;                           // beyond it the patch goes on flat
  };
  std::vector<Patch> patches_;
};

/// Mirror, match, fit again: images over the estimate meet the surfaces on the other side, half
/// their distance along the direction is what the surface is wrong by there. What remains across
/// determines how the direction turns.
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
  MidSurface votes_;
};

}  // namespace symsurf
