#include "preprocess/preprocessing.h"

#include <utility>

#include "preprocess/boundary.h"
#include "preprocess/outlier_removal.h"
#include "preprocess/row_stages.h"
#include "preprocess/surface_samples.h"

namespace symsurf {

void Stage::replace(Cloud& cloud, Points points, Points normals) {
  points_ = std::move(points);
  normals_ = std::move(normals);
  cloud.points = points_;
  cloud.normals = normals_;
}

std::vector<std::unique_ptr<Stage>> make_stages(const Preprocessing& policy, Index minimum_points,
                                                const ParameterValues& values,
                                                bool refuse_nonfinite) {
  std::vector<std::unique_ptr<Stage>> stages;
  stages.push_back(std::make_unique<NonfiniteRemoval>(minimum_points, refuse_nonfinite));
  if (policy.remove_outliers) stages.push_back(std::make_unique<OutlierRemoval>(minimum_points));
  if (policy.sample_faces) stages.push_back(std::make_unique<SurfaceSamples>());
  if (policy.merge_duplicates) stages.push_back(std::make_unique<DuplicateMerge>(minimum_points));
  if (policy.order_points) stages.push_back(std::make_unique<PositionOrder>());
  if (policy.extract_boundary)
    stages.push_back(
        std::make_unique<BoundaryExtraction>(minimum_points, policy.keep_interior, values));
  return stages;
}

}  // namespace symsurf
