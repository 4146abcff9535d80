#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

namespace symsurf {

Values candidate_values(const Result& result) {
  const auto count = static_cast<Index>(result.candidates.size());
  if (count == 0) return {};
  Eigen::MatrixXd scores(count, 1), normals(count, 3), offsets(count, 1);
  bool planes = true;
  for (Index row = 0; row < count; ++row) {
    const Result& candidate = result.candidates[row];
    scores(row, 0) = candidate.score;
    const auto* plane = dynamic_cast<const Plane*>(candidate.mirror.get());
    planes = planes && plane;
    if (!planes) continue;
    normals.row(row) = plane->normal().transpose();
    offsets(row, 0) = plane->offset();
  }
  if (!planes) return {{"candidate_scores", scores}};
  return {
      {"candidate_scores", scores}, {"candidate_normals", normals}, {"candidate_offsets", offsets}};
}

}  // namespace symsurf
