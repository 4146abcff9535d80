#pragma once

#include <symsurf/points.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace symsurf {

/// Rounding of coordinates in single precision, over the size of the shape.
inline constexpr double single_rounding = 1e-6;

/// The same of double precision, after some arithmetic.
inline constexpr double double_rounding = 1e-9;

/// The projection across a unit vector.
inline Matrix3 across(const Vector3& unit) { return Matrix3::Identity() - unit * unit.transpose(); }

/// The points that are finite: what has no foot on a mirror is not.
inline Points finite_rows(Points points) {
  Index rows = 0;
  for (Index i = 0; i < points.rows(); ++i)
    if (points.row(i).allFinite()) points.row(rows++) = points.row(i).eval();
  points.conservativeResize(rows, 3);
  return points;
}

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Keeps the k least of what it is given, least first. Whether the candidate is one of them.
template <typename T>
bool keep_best(std::vector<T>& found, std::size_t k, const T& candidate) {
  const bool full = found.size() == k;
  if (full && !(candidate < found.back())) return false;
  if (full) found.pop_back();
  found.insert(std::upper_bound(found.begin(), found.end(), candidate), candidate);
  return true;
}

/// Of items that stand best first, keeps the first `count` that are not alike(item, kept) to one
/// kept before.
template <typename Item, typename Alike>
void suppress_non_maxima(std::vector<Item>& items, std::size_t count, const Alike& alike) {
  std::vector<Item> kept;
  for (Item& item : items) {
    if (kept.size() == count) break;
    const bool is_new = std::none_of(kept.begin(), kept.end(),
                                     [&](const Item& other) { return alike(item, other); });
    if (is_new) kept.push_back(std::move(item));
  }
  items = std::move(kept);
}

/// Two unit vectors orthogonal to a unit direction and to each other, the same for the same bits.
inline Eigen::Matrix<double, 3, 2> orthogonal_to(const Vector3& direction) {
  Index smallest;
  direction.cwiseAbs().minCoeff(&smallest);
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = direction.cross(Vector3::Unit(smallest)).normalized();
  across.col(1) = direction.cross(across.col(0));
  return across;
}

/// The rotation whose last row is the unit normal.
inline Matrix3 frame_of(const Vector3& normal) {
  Matrix3 frame;
  frame << orthogonal_to(normal).transpose(), normal.transpose();
  return frame;
}

/// The value with `share`, 0 <= share < 1, of the values before it in order; of at least one value.
template <typename T>
T quantile(std::vector<T> values, double share) {
  const auto position =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), position, values.end());
  return *position;
}

/// Tukey's biweight of a residual, in units of that from which on it weighs nothing.
inline double biweight(double residual) {
  const double inside = 1 - residual * residual;
  return residual < 1 ? inside * inside : 0;
}

/// The middle value; of an even number the upper one.
template <typename T>
T median(std::vector<T> values) {
  return quantile(std::move(values), 0.5);
}

/// Points, or triangles, as the rows of a matrix.
inline Points rows_of(const std::vector<Vector3>& points) {
  Points rows(static_cast<Index>(points.size()), 3);
  for (Index i = 0; i < rows.rows(); ++i) rows.row(i) = points[i].transpose();
  return rows;
}

inline Triangles rows_of(const std::vector<std::array<Index, 3>>& triangles) {
  Triangles rows(static_cast<Index>(triangles.size()), 3);
  for (Index i = 0; i < rows.rows(); ++i)
    rows.row(i) << triangles[i][0], triangles[i][1], triangles[i][2];
  return rows;
}

/// The length of a direction, to divide it by: 1 where it differs from 1 by rounding only, so that
/// unit vectors keep their bits and a mirror made from another's numbers has the same ones.
inline double length_of(const Vector3& direction) {
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  const double length = direction.norm();
  return std::abs(length - 1) <= rounding ? 1 : length;
}

}  // namespace symsurf

/// For small loops that everything waits for: compiled for AVX2 as well as for the least processor,
/// chosen as the program starts. The bits are the same, as products and sums are not fused.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define SYMSURF_VECTORISED __attribute__((target_clones("avx2", "default")))
#else
#define SYMSURF_VECTORISED
#endif
