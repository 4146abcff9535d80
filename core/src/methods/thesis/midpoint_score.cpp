#include "methods/thesis/midpoint_score.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/symmetric_eigen.h"
#include "cloud/sheet_spacing.h"

namespace symsurf {

namespace {

// Distance of the first of the neighbours from the plane through the others.
double off_plane(PointsView midpoints, const std::vector<Neighbour>& neighbours) {
  Vector3 mean = Vector3::Zero();
  for (std::size_t k = 1; k < neighbours.size(); ++k) mean += midpoints[neighbours[k].index];
  mean /= static_cast<double>(neighbours.size() - 1);
  Matrix3 scatter = Matrix3::Zero();
  for (std::size_t k = 1; k < neighbours.size(); ++k) {
    const Vector3 w = midpoints[neighbours[k].index] - mean;
    scatter.noalias() += w * w.transpose();
  }
  const Vector3 normal = eigen_of(scatter).vectors.col(0);
  return std::abs(normal.dot(midpoints[neighbours[0].index] - mean));
}

}  // namespace

double midpoint_score(PointsView points, const PointTree& tree, const Result& result,
                      const Context& context) {
  constexpr Index neighbours = 11, samples = 2000, grain = 64;
  const PointsView midpoints(result.surface_points);
  if (midpoints.size() < neighbours) return 0;
  const double tolerance = sheet_spacing(points, tree);
  if (!(tolerance > 0)) return 0;

  const PointTree midpoint_tree(midpoints, context.stage(0, 0.3));
  const Index stride = std::max<Index>(1, midpoints.size() / samples);
  const Index sampled = (midpoints.size() + stride - 1) / stride;
  const double agreeing =
      parallel_sum(context.stage(0.3, 1), sampled, grain, 0.0, [&](Index begin, Index end) {
        double sum = 0;
        std::vector<Neighbour> found;
        for (Index row = begin * stride; row < end * stride && row < midpoints.size();
             row += stride) {
          midpoint_tree.nearest(midpoints[row], neighbours, found);
          found.front().index = row;  // of equal midpoints another may stand first
          const double off = std::hypot(result.residuals[row], 2 * off_plane(midpoints, found));
          const Vector3 chord = points[result.pairs(row, 0)] - points[result.pairs(row, 1)];
          const double moved = std::clamp(chord.norm() / 2 / tolerance - 1, 0.0, 1.0);
          sum += moved * std::exp(-off * off / (2 * tolerance * tolerance));
        }
        return sum;
      });

  std::vector<char> paired(points.size(), 0);
  for (const Index i : result.pairs.reshaped()) paired[i] = 1;
  const double covered = static_cast<double>(std::count(paired.begin(), paired.end(), 1)) /
                         static_cast<double>(points.size());
  return covered * agreeing / static_cast<double>(sampled);
}

}  // namespace symsurf
