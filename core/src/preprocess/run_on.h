#pragma once

#include "cloud/cloud.h"

namespace symsurf {

/// Runs on the rows of a cloud that `part` chooses, and has it hand on to all what is found of
/// them.
template <typename Part, typename Run>
Result run_on(const Part& part, const Cloud& cloud, Index minimum_points, const Context& context,
              const Run& run) {
  const Points points = part.rows(cloud.points);
  const Points normals = cloud.normals.empty() ? Points(0, 3) : part.rows(cloud.normals);
  Cloud apart = checked_cloud(points, normals, minimum_points, context.stage(0, 0));
  apart.seed = cloud.seed;
  apart.vertices = cloud.vertices;
  Result result = run(apart);
  part.hand_on(result);
  return result;
}

}  // namespace symsurf
