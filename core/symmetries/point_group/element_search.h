#pragma once

#include <symsurf/context.h>

#include <vector>

#include "point_group/symmetry_test.h"

namespace symsurf {

/// A mirror plane, by its normal, or a rotation axis that a cloud may have.
struct FoundDirection {
  GroupPose pose;  ///< z along it
  OrbitVote vote;
  Index order = 1;  ///< of the axis; 0: continuous
  Vector3 z() const { return pose.axes.col(2); }
};

constexpr double same_direction = 0.05;  // radians, of directions fitted well: 3 degrees

/// Some of the planes, the best first: all others follow from a few.
std::vector<FoundDirection> find_planes(const SymmetryTest& test);

/// Nearest to all planes, and where these leave it free to the centroid.
Vector3 centre_of(const std::vector<FoundDirection>& planes);

/// Axes along the lines in which planes meet, their normals and the principal axes, where these
/// are any those of half turns between surfels; the highest order first, continuous ones before.
/// Where one is continuous, or two are of order 3 or more, as in a polyhedral group, and fit well,
/// the search ends.
std::vector<FoundDirection> find_axes(const SymmetryTest& test,
                                      const std::vector<FoundDirection>& planes,
                                      const Vector3& centre);

}  // namespace symsurf
