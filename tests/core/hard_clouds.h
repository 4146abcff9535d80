#pragma once

#include <algorithm>
#include <vector>

#include "cloud/point_tree.h"
#include "random_cloud.h"

namespace symsurf {

inline std::vector<Neighbour> all_by_distance(const Points& points, const Vector3& query) {
  std::vector<Neighbour> all;
  for (Index i = 0; i < points.rows(); ++i)
    all.push_back({i, (points.row(i).transpose() - query).squaredNorm()});
  std::sort(all.begin(), all.end());
  return all;
}

inline Points with_outlier(Points points, double distance) {
  points.row(points.rows() / 2) << distance, -distance, distance / 3;
  return points;
}

inline Points flattened(Points points, const Vector3& scale) { return points * scale.asDiagonal(); }

// Clouds that are hard on grids, boxes and tie-breaking.
inline std::vector<Points> clouds(std::uint64_t seed) {
  RandomCloud random(seed);
  const Points box = random.box(700);
  return {box,
          random.sphere(513),
          flattened(box, {1, 1, 0}),
          flattened(box, {1, 0, 0}),
          flattened(box, {0, 0, 0}),
          with_outlier(box, 1e3),
          with_outlier(box, 1e9),
          box.topRows(1),
          box.topRows(9),
          (box.array() + 4e6).matrix(),
          box * 1e-9,
          random.lattice(700, 4)};
}

inline std::vector<Vector3> queries(const Points& points, RandomCloud& random) {
  std::vector<Vector3> queries;
  const double size = 1 + points.cwiseAbs().maxCoeff();
  for (int i = 0; i < 30; ++i) {
    queries.push_back(points.row(i * 17 % points.rows()));
    queries.push_back(queries.back() + random.in_box() * 0.1);
    queries.push_back(random.in_box() * size);
    queries.push_back(random.in_box() * size * 1e3);
  }
  return queries;
}

}  // namespace symsurf
