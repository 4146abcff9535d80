#pragma once

#include <symsurf/points.h>

#include <string>
#include <vector>

namespace symsurf {

/// A point group. Those that are made here stand upright: the main axis along z, and along x, in
/// this order of preference, the normal of a mirror that holds the main axis or an axis of order 2.
struct PointGroup {
  struct Axis {
    Vector3 direction;
    Index order;  ///< 0: continuous
  };

  PointGroup() = default;
  /// Named by its elements, the identity first; `continuous`: with any turn about z.
  explicit PointGroup(std::vector<Matrix3> elements, bool continuous = false);

  std::string name = "C1";                             ///< Schoenflies'
  std::vector<Matrix3> elements{Matrix3::Identity()};  ///< the identity first
  bool continuous = false;                             ///< any turn about z is an element, too
  bool all = false;                                    ///< K: any turn is

  std::vector<Vector3> plane_normals() const;
  std::vector<Axis> axes() const;  ///< the highest order first
  bool inversion() const;
};

/// What an axial group has beside the turns about its main axis.
struct AxialElements {
  bool across = false;    ///< the mirror across the main axis
  bool rotary = false;    ///< turns by half the least angle, then reflected across
  bool vertical = false;  ///< mirrors that hold the main axis, one with its normal along x
  bool twofold = false;   ///< axes of order 2 across it, one along x
};

/// `order` 0: continuous.
PointGroup axial_group(Index order, const AxialElements& elements);

PointGroup inversion_group();   ///< Ci
PointGroup reflection_group();  ///< Cs, its mirror across z
PointGroup spherical_group();   ///< K

/// T, O or I for the highest order of an axis, 3, 4 or 5, with more where it has a mirror.
PointGroup polyhedral_group(Index highest_order, bool inversion, bool mirror);

/// The group that the generators make, the identity first.
std::vector<Matrix3> closed(const std::vector<Matrix3>& generators);

bool contains(const std::vector<Matrix3>& elements, const Matrix3& element);

Matrix3 turn(const Vector3& axis, double angle);
Matrix3 reflection(const Vector3& normal);

/// Whether the lines along two unit vectors are, within an angle in radians.
bool are_parallel(const Vector3& a, const Vector3& b, double angle);

}  // namespace symsurf
