#include "cloud.h"

#include <symsurf/errors.h>

#include <Eigen/Dense>
#include <cmath>
#include <string>

#include "parallel.h"

namespace symsurf {

namespace {

constexpr Index grain = 1 << 16;

// A cloud thinner than this, against its length, is a line.
constexpr double line_thinness = 1e-8;

void require_area(PointsView points, const Vector3& low, const Vector3& high,
                  const Context& context) {
  const double extent = (high - low).maxCoeff();
  if (!(extent > 0))
    throw InvalidInput("all " + std::to_string(points.size()) + " points are equal");
  const Vector3 centre = (low + high) / 2;
  // About the mean, in units of the extent, so that neither far-off nor tiny clouds lose digits.
  Vector3 mean = Vector3::Zero();
  const auto centred = [&](Index i) -> Vector3 { return (points[i] - centre) / extent; };
  mean = parallel_sum(context, points.size(), grain, mean,
                      [&](Index begin, Index end) {
                        Vector3 sum = Vector3::Zero();
                        for (Index i = begin; i < end; ++i) sum += centred(i);
                        return sum;
                      }) /
         static_cast<double>(points.size());
  Matrix3 scatter = Matrix3::Zero();
  scatter = parallel_sum(context, points.size(), grain, scatter, [&](Index begin, Index end) {
    Matrix3 sum = Matrix3::Zero();
    for (Index i = begin; i < end; ++i) {
      const Vector3 x = centred(i) - mean;
      sum.noalias() += x * x.transpose();
    }
    return sum;
  });
  const Vector3 spread =
      Eigen::SelfAdjointEigenSolver<Matrix3>(scatter, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(spread[1] > line_thinness * line_thinness * spread[2]))
    throw InvalidInput("all " + std::to_string(points.size()) + " points lie on one line");
}

}  // namespace

void require_finite(PointsView rows, const char* what) {
  // One pass without branches finds out whether; a second one only then finds out where.
  double sum = 0;
  for (Index i = 0; i < 3 * rows.size(); ++i) sum += 0 * rows.data()[i];
  if (sum == 0) return;
  for (Index i = 0; i < rows.size(); ++i)
    if (!rows[i].allFinite())
      throw InvalidInput(std::string(what) + " " + std::to_string(i) + " is " +
                         to_string(Value(rows[i])) + "; coordinates must be finite");
}

Cloud checked_cloud(PointsView points, PointsView normals, Index minimum_points,
                    const Context& context) {
  if (points.size() < minimum_points)
    throw InvalidInput(std::to_string(points.size()) + " points given; at least " +
                       std::to_string(minimum_points) + " are needed");
  require_finite(points, "point");
  const Vector3 low = points.matrix().colwise().minCoeff();
  const Vector3 high = points.matrix().colwise().maxCoeff();
  require_area(points, low, high, context);

  if (!normals.empty()) {
    if (normals.size() != points.size())
      throw InvalidInput(std::to_string(normals.size()) + " normals given for " +
                         std::to_string(points.size()) + " points; one a point is needed");
    require_finite(normals, "normal");
    for (Index i = 0; i < normals.size(); ++i)
      if (normals[i].isZero(0))
        throw InvalidInput("normal " + std::to_string(i) + " is (0, 0, 0); a direction is needed");
  }
  return {points, normals, (high - low).norm(), 0};
}

}  // namespace symsurf
