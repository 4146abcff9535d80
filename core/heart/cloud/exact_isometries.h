#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <limits>
#include <vector>

#include "cloud/point_tree.h"

namespace symsurf {

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
