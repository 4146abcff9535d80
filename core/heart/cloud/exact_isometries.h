#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <limits>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/point_tree.h"

namespace symsurf {

struct ExactIsometries {
  std::vector<Matrix3> maps;        ///< the identity first
  std::vector<Matrix3> generators;  ///< of which all are products
  Vector3 centre;                   ///< of the points, copies counted once: it stays in place
};

/// The orthogonal maps about the centroid of a point set that take each of its points to one of
/// them, to the rounding of single precision: by trying all images of two points (Atallah 1985 in
/// the plane) with few as far out as they are (Wolter, Woo and Volz 1985), then fitted to all; of
/// what is found all products. At most about `most`. `checked`: how many of the points, spread
/// over them, are asked where they are taken. The identity alone where of many points too many lie
/// as far out, as on a sphere. `tolerance`: how far off its partner an image may be, where that is
/// more, in input units.
ExactIsometries exact_isometries(PointsView points, const PointTree& tree, const Context& context,
                                 std::size_t most = std::numeric_limits<std::size_t>::max(),
                                 Index checked = std::numeric_limits<Index>::max(),
                                 double tolerance = 0);

/// Maps that are products of each other but for their rounding, made a group to the last digit:
/// each becomes the mean of its quotients, A_g = mean_h A_gh A_h' (Grove, Karcher and Ruh 1974).
/// None where a product is none of them.
std::vector<Matrix3> polished(const std::vector<Matrix3>& maps);

/// The reflections among them, by some of the points: the planes that map a cloud onto itself, but
/// for one that all points lie on.
std::vector<Plane> exact_planes(const Cloud& cloud, const Context& context);

/// Of planes that are worth the same, as those of a box are, the one across the longer extent comes
/// first, whatever the order of the points.
void longest_first(std::vector<Plane>& planes, const PrincipalFrame& frame);

/// The orthonormal basis with its first axis along one vector and its second on the side of
/// another.
Matrix3 basis_of(const Vector3& one, const Vector3& other);

}  // namespace symsurf
