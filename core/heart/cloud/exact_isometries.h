#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <limits>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "cloud/principal_frame.h"
#include "cloud/surfels.h"

namespace symsurf {

/// The planes that map a cloud onto itself to rounding, all of them, in the principal frame.
///
/// Such a plane goes through the centroid and swaps points that lie equally far from it (Wolter,
/// Woo and Volz 1985). Of two points a and b and the few as far out as they are, it is the bisector
/// of a and another, or of b and another, or holds a and b. None where the points that lie as far
/// out are too many to try, as on a sphere.
std::vector<UnitPlane> exact_planes(const Cloud& cloud, const NearestPoints& points,
                                    const Surfels& samples);

/// The same of points in this process, copies counted once, in input units.
std::vector<Plane> exact_planes(PointsView points, const Context& context);

struct ExactIsometries {
  std::vector<Matrix3> maps;        ///< the identity first
  std::vector<Matrix3> generators;  ///< of which all are products
};

/// The orthogonal maps about the centroid of a point set that take each of its points to one of
/// them, to the rounding of single precision: by trying all images of two points (Atallah 1985 in
/// the plane), then fitted to all; of what is found all products. At most about `most`.
ExactIsometries exact_isometries(PointsView points, const PointTree& tree, const Context& context,
                                 std::size_t most = std::numeric_limits<std::size_t>::max());

/// The orthonormal basis with its first axis along one vector and its second on the side of
/// another.
Matrix3 basis_of(const Vector3& one, const Vector3& other);

}  // namespace symsurf
