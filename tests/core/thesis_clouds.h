#pragma once

#include <symsurf/points.h>

#include <algorithm>
#include <array>
#include <vector>

#include "random_cloud.h"

namespace symsurf {

/// Small clouds of every kind that matters to searches: scattered, on surfaces, on lattices where
/// distances tie exactly, in columns that projections lay on each other, with doubled points, flat.
inline Points thesis_cloud(std::uint64_t seed) {
  RandomCloud random(seed);
  const auto n = static_cast<Index>(random.uniform(12, 70));
  switch (seed % 6) {
    case 0:
      return random.box(n);
    case 1:
      return random.sphere(n);
    case 2:
      return random.lattice(n, 3);
    case 3: {  // two surfaces, the second the first one's image along z
      Points half = random.box(n), both(2 * n, 3);
      half.col(2) = half.col(2) / 10 + Eigen::VectorXd::Constant(n, 2);
      both << half, half;
      for (Index i = 0; i < n; ++i) both(n + i, 2) = 2 * std::sin(half(i, 0)) - half(i, 2);
      return both;
    }
    case 4: {  // every point twice
      const Points half = random.box(n);
      Points both(2 * n, 3);
      both << half, half;
      return both;
    }
    default: {  // in a plane
      Points flat = random.box(n);
      flat.col(1).setZero();
      return flat;
    }
  }
}

/// By x, then y, then z: in this order the methods take the first of equals, as loops over it do.
inline Points ascending(const Points& points) {
  std::vector<std::array<double, 3>> rows;
  for (const auto& x : points.rowwise()) rows.push_back({x[0], x[1], x[2]});
  std::sort(rows.begin(), rows.end());
  Points sorted(points.rows(), 3);
  for (Index i = 0; i < sorted.rows(); ++i) sorted.row(i) = Vector3(rows[i].data()).transpose();
  return sorted;
}

}  // namespace symsurf
