#include "cloud/surface_points.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/math.h"
#include "base/parallel.h"
#include "cloud/cloud.h"
#include "cloud/surface_spacing.h"

namespace symsurf {

LocalPlane plane_through(const Points& points, std::span<const Neighbour> neighbourhood) {
  Vector3 mean = Vector3::Zero();
  for (const Neighbour& n : neighbourhood) mean += points.row(n.index).transpose();
  mean /= static_cast<double>(neighbourhood.size());
  Matrix3 scatter = Matrix3::Zero();
  for (const Neighbour& n : neighbourhood) {
    const Vector3 d = points.row(n.index).transpose() - mean;
    scatter += d * d.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Matrix3> eigen;
  eigen.computeDirect(scatter);
  // Three numbers of the plane are fitted.
  const double free = std::max<double>(1, static_cast<double>(neighbourhood.size()) - 3);
  return {eigen.eigenvectors(), std::sqrt(std::max(0.0, eigen.eigenvalues()[0]) / free)};
}

SurfacePoints::SurfacePoints(Points positions, const Context& context, Index neighbourhood)
    : points(std::move(positions)),
      tree(points, context.stage(0, 0.4)),
      neighbours(size(), ring),
      normals(size(), 3),
      spacings(size()) {
  std::vector<double> deviations(size());
  constexpr Index grain = 512;
  parallel_for(context.stage(0.4, 1), size(), grain, [&](Index begin, Index end) {
    std::vector<Neighbour> around;
    for (Index p = begin; p < end; ++p) {
      const std::int32_t i = tree.order()[p];
      tree.nearest(point(i), ring + 1, around);
      spacings[i] = spacing_at(around);
      const std::size_t planar = std::min<std::size_t>(neighbourhood, around.size());
      const LocalPlane plane = plane_through(points, std::span(around).first(planar));
      normals.row(i) = plane.axes.col(0).transpose();
      deviations[i] = plane.deviation;
      int column = 0;
      for (const Neighbour& other : around)
        if (other.index != i && column < ring)
          neighbours(i, column++) = static_cast<std::int32_t>(other.index);
      for (; column < ring; ++column) neighbours(i, column) = i;
    }
  });
  spacing = median(std::vector(spacings.begin(), spacings.end()));
  noise = median(std::move(deviations));
}

SurfacePoints::SurfacePoints(const Points& all, Index count, const Context& context)
    : SurfacePoints(chosen_rows(all, spread_along_curve(all, count, context.stage(0, 0.3))),
                    context.stage(0.3, 1)) {}

std::vector<Index> spread_along_curve(PointsView points, Index count, const Context& context) {
  const PointTree curve(points, context);
  std::vector<Index> rows(std::min(points.size(), count));
  for (std::size_t k = 0; k < rows.size(); ++k)
    rows[k] = curve.order()[k * static_cast<std::size_t>(points.size()) / rows.size()];
  return rows;
}

}  // namespace symsurf
