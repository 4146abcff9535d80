#pragma once

#include <symsurf/analyses.h>
#include <symsurf/context.h>

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "cloud/cloud.h"
#include "point_group/point_group.h"
#include "point_group/surface_distance.h"

namespace symsurf {

/// Where a point group stands in the principal frame.
struct GroupPose {
  Matrix3 axes = Matrix3::Identity();  ///< columns: where its x, y and z point, right-handed
  Vector3 centre = Vector3::Zero();

  /// An element, given in the group's standard orientation, as it stands here.
  Eigen::Isometry3d placed(const Matrix3& element) const;

  /// Of groups with z along a direction; x wherever.
  static GroupPose along(const Vector3& z, const Vector3& centre);
};

/// A point group as it stands in a shape, and how far it takes the shape off itself.
struct HeldGroup {
  PointGroup group;
  GroupPose pose;
  MapDeviation deviation;

  /// Of the group; of continuous ones more than any finite group has.
  double size() const;

  /// All elements but the identity, of a continuous group with some turns about its axes.
  std::vector<Eigen::Isometry3d> maps() const;

  /// Whether another group is a part of this one, as they stand, to some degrees.
  bool holds(const HeldGroup& other) const;
};

/// The point groups that a shape may have, each larger than the exact one, which is the first, and
/// holding it: C1, or what maps each vertex or point onto one. In no order; none is farther off the
/// shape than an eighth of the diameter.
///
/// A grid of distances proposes elements, tried in many directions; those of a group are fitted in
/// one pose, and all of them measured. `tolerance`, in units of the frame: of a small set, of which
/// isometries alone count, how far they may be off.
std::vector<HeldGroup> possible_groups(const Cloud& shape, const PrincipalFrame& frame,
                                       const SurfaceDistance& surface, double tolerance,
                                       const Context& context);

/// The axis of a surface of revolution of which part of the turn is there.
struct Revolution {
  GroupPose pose;          ///< z along it
  MapDeviation deviation;  ///< of turns by parts of what is there
  double turn = 0;         ///< the share of the full turn that is there, (0, 1]
};

/// All normals of a surface of revolution meet its axis: a linear line complex (Pottmann and
/// Randrup, "Rotational and helical surface approximation for reverse engineering", 1998), from
/// random samples, then by weights. Then the points, turned into one half plane, are to scatter
/// least about a profile. The best of a few.
std::optional<Revolution> find_revolution(const Cloud& cloud, const SurfaceDistance& surface,
                                          const Context& context);

/// A point group that stands in a pose of the principal frame, in input units.
Symmetries described(const HeldGroup& held, const PrincipalFrame& frame);

/// The axis of the highest order, continuous ones first, or that of what is mostly a surface of
/// revolution, whatever spoils it, as a handle or a broken edge does. Throws what find_symmetries()
/// does.
std::optional<SymmetryAxis> find_axis(PointsView points, TrianglesView faces,
                                      const Context& context);

}  // namespace symsurf
