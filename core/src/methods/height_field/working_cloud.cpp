#include "methods/height_field/working_cloud.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/math.h"
#include "base/parallel.h"

namespace symsurf {

namespace {

constexpr Index neighbours = 12, spacing_rank = 6;

std::vector<Index> spread_along_curve(const Points& points, Index count, const Context& context) {
  const PointTree curve(points, context);
  std::vector<Index> rows(std::min(points.rows(), count));
  for (std::size_t k = 0; k < rows.size(); ++k)
    rows[k] = curve.order()[k * static_cast<std::size_t>(points.rows()) / rows.size()];
  return rows;
}

}  // namespace

WorkingCloud::WorkingCloud(const Points& framed, Index count, const Context& context)
    : rows(spread_along_curve(framed, count, context.stage(0, 0.3))),
      points(framed(rows, Eigen::indexing::all)),
      tree(points, context.stage(0.3, 0.5)) {
  normals.resize(size(), 3);
  flatness.resize(size());
  spacings.resize(size());
  parallel_for(context.stage(0.5, 1), size(), 512, [&](Index begin, Index end) {
    std::vector<Neighbour> near;
    for (Index i = begin; i < end; ++i) {
      tree.nearest(point(i), neighbours, near);
      const std::size_t rank = std::min<std::size_t>(spacing_rank, near.size() - 1);
      spacings[i] = std::sqrt(near[rank].squared_distance * std::acos(-1) / spacing_rank);
      Vector3 mean = Vector3::Zero();
      for (const Neighbour& n : near) mean += point(n.index);
      mean /= static_cast<double>(near.size());
      Matrix3 scatter = Matrix3::Zero();
      for (const Neighbour& n : near) {
        const Vector3 d = point(n.index) - mean;
        scatter += d * d.transpose();
      }
      Eigen::SelfAdjointEigenSolver<Matrix3> eigen;
      eigen.computeDirect(scatter);
      normals.row(i) = eigen.eigenvectors().col(0).transpose();
      flatness[i] =
          std::sqrt(std::max(0.0, eigen.eigenvalues()[0]) / static_cast<double>(near.size()));
    }
  });
  spacing = median(std::vector(spacings.begin(), spacings.end()));
}

}  // namespace symsurf
