#pragma once

// Points and triangles as the core takes them; their normals, and fewer of them.

#include <symsurf/context.h>

#include <Eigen/Core>
#include <cstdint>
#include <string_view>

namespace symsurf {

using Index = Eigen::Index;
using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Matrix4 = Eigen::Matrix4d;

/// n x 3, one point a row, in input units.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
/// m x 2 indices into the input: a point, and the point its image falls on.
using Pairs = Eigen::Matrix<Index, Eigen::Dynamic, 2, Eigen::RowMajor>;
/// m x 3 indices into a list of vertices.
using Triangles = Eigen::Matrix<Index, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// n x 3 contiguous doubles that belong to somebody else, read where they lie.
class PointsView {
 public:
  PointsView() = default;
  PointsView(const double* coordinates, Index size) : data_(coordinates), size_(size) {}
  PointsView(const Points& points) : data_(points.data()), size_(points.rows()) {}

  Index size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const double* data() const { return data_; }

  Vector3 operator[](Index i) const { return {data_[3 * i], data_[3 * i + 1], data_[3 * i + 2]}; }
  Eigen::Map<const Points> matrix() const { return {data_, size_, 3}; }

 private:
  const double* data_ = nullptr;
  Index size_ = 0;
};

/// m x 3 contiguous indices into a point set that belong to somebody else, read where they lie.
class TrianglesView {
 public:
  TrianglesView() = default;
  TrianglesView(const Index* corners, Index size) : data_(corners), size_(size) {}
  TrianglesView(const Triangles& triangles) : data_(triangles.data()), size_(triangles.rows()) {}

  Index size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const Index* data() const { return data_; }

  /// The three corners of a triangle.
  const Index* operator[](Index i) const { return data_ + 3 * i; }

 private:
  const Index* data_ = nullptr;
  Index size_ = 0;
};

/// Unit normals, one a point, from each point's `neighbours` nearest (itself among them; equal
/// distances: the lowest index). "pca": the direction of least variance, its largest component
/// positive. "regression": z = b0 + b1 x + b2 y by least squares (minimum norm where it is rank
/// deficient), normal (-b1, -b2, 1): thesis 3.4.1; poor on vertical patches.
/// Throws InvalidInput for fewer points than neighbours, InvalidParameter for fewer than 3
/// neighbours or an unknown name.
Points estimate_normals(PointsView points, Index neighbours = 10, std::string_view method = "pca",
                        const Context& context = {});

/// The simplification of Hruda et al. (2022): a grid of cells l_avg / k, anchored at the bounding
/// box's minimum, k = 1, 2, 3, ... until at least `count` cells are occupied (l_avg: the mean
/// distance of the points from their centroid); the mean of each occupied cell, in lexicographic
/// order of the cells. With `count` or fewer distinct points, these points themselves, in
/// lexicographic order.
/// From 128 on k grows by a 64th of the power of two below it, so that far outliers cost little,
/// and no farther than 2^51 cells along the box's longest side: points nearer to each other are
/// one, and fewer than `count` come out.
/// Throws InvalidInput for no points or NaN, InvalidParameter for a count below 1, and Cancelled.
Points downsample(PointsView points, Index count, const Context& context = {});

}  // namespace symsurf
