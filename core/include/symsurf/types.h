#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace symsurf {

using Index = std::int64_t;
using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Matrix4 = Eigen::Matrix4d;

/// n x 3, one point a row, in input units.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
/// m x 2 indices into the input: a point, and the point its image falls on.
using Pairs = Eigen::Matrix<Index, Eigen::Dynamic, 2, Eigen::RowMajor>;
/// m x 3 indices into a list of vertices.
using Triangles = Eigen::Matrix<Index, Eigen::Dynamic, 3, Eigen::RowMajor>;

}  // namespace symsurf
