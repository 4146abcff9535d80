#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include "distributed/partition.h"

namespace symsurf {

/// The coordinate frame in which methods compute (principal component analysis): the centroid at 0,
/// the principal axes along x, y, z, longest first, the bounding box's diagonal 1. It moves with
/// the cloud, so results do not depend on unit or pose. The axes' signs follow the third moments,
/// or where these are but rounding make the largest component positive; it may be left-handed.
struct PrincipalFrame {
  Vector3 centroid = Vector3::Zero();
  Matrix3 axes = Matrix3::Identity();  ///< columns, in input coordinates
  double size = 1;                     ///< input units a unit of the frame
  Vector3 variance = Vector3::Zero();  ///< along the axes, in input units squared
  Vector3 low = Vector3::Zero(), high = Vector3::Zero();  ///< the box, in the frame

  Vector3 to_frame(const Vector3& x) const;
  Vector3 from_frame(const Vector3& x) const;
};

/// Of the points of all processes, which must be finite. A cloud of equal points gets a size of 0.
PrincipalFrame principal_frame(PointsView own, const Partition& partition, const Context& context);

}  // namespace symsurf
