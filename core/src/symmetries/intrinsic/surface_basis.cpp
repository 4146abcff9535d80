#include "symmetries/intrinsic/surface_basis.h"

#include <algorithm>

#include "base/math.h"
#include "base/sparse_eigen.h"

namespace symsurf {

SurfaceBasis surface_basis(const ConnectedSurface& surface, Index count, const Context& context) {
  constexpr double shift = -1e-2;  // a body ten times as long as wide has a first value of 1
  const auto& [stiffness, areas] = surface.laplacian;
  const auto [values, vectors] =
      least_eigenpairs(stiffness, areas, std::min(count + 1, stiffness.rows()), shift, context);
  const Index found = std::max<Index>(values.size() - 1, 0);
  return {values.tail(found), vectors.rightCols(found)};
}

SampledPoints surface_samples(const ConnectedSurface& surface, Index count,
                              const Context& context) {
  SampledPoints samples;
  const Index size = surface.points.rows();
  count = std::min(count, size);
  samples.distances.resize(count, count);
  Eigen::MatrixXd from(size, count);
  Eigen::VectorXd nearest = edge_distances(surface, 0);
  for (Index k = 0; k < count; ++k) {
    context.report(static_cast<double>(k) / static_cast<double>(count));
    Index farthest;
    nearest.maxCoeff(&farthest);
    from.col(k) = edge_distances(surface, farthest);
    nearest = k == 0 ? from.col(k) : Eigen::VectorXd(nearest.cwiseMin(from.col(k)));
    samples.vertices.push_back(farthest);
  }
  samples.distances = from(samples.vertices, Eigen::indexing::all);
  samples.distances /= samples.distances.maxCoeff();
  samples.weights = Eigen::VectorXd::Zero(count);
  for (Index v = 0; v < size; ++v) {
    Index owner;
    from.row(v).minCoeff(&owner);
    samples.weights[owner] += surface.laplacian.areas[v];
  }
  return samples;
}

}  // namespace symsurf
