#include "cloud/principal_frame.h"

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"

namespace symsurf {

namespace {

constexpr Index grain = 1 << 15;

struct Extent {
  Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity());
  Vector3 high = -low;
  Vector3 skewness = Vector3::Zero();

  Extent& operator+=(const Extent& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
    skewness += other.skewness;
    return *this;
  }
};

}  // namespace

Vector3 PrincipalFrame::to_frame(const Vector3& x) const {
  return axes.transpose() * (x - centroid) * (1 / size);
}

Points PrincipalFrame::to_frame(PointsView points, const Context& context) const {
  Points inside(points.size(), 3);
  parallel_for(context, points.size(), grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) inside.row(i) = to_frame(points[i]).transpose();
  });
  return inside;
}

Vector3 PrincipalFrame::from_frame(const Vector3& x) const { return centroid + size * (axes * x); }

PrincipalFrame PrincipalFrame::with_size(double other) const {
  const double longer = size / other;
  return {centroid, axes, other, variance, longer * low, longer * high};
}

PrincipalFrame principal_frame(PointsView points, const Context& context) {
  const double count = static_cast<double>(points.size());
  PrincipalFrame frame;
  // About the first point: far-off clouds keep their digits.
  const Vector3 first = points[0];
  frame.centroid =
      first +
      parallel_sum(context, points.size(), grain, Vector3(0, 0, 0), [&](Index begin, Index end) {
        Vector3 sum = Vector3::Zero();
        for (Index i = begin; i < end; ++i) sum += points[i] - first;
        return sum;
      }) / count;
  const Matrix3 zero = Matrix3::Zero();
  const Matrix3 scatter =
      parallel_sum(context, points.size(), grain, zero, [&](Index begin, Index end) {
        Matrix3 sum = Matrix3::Zero();
        for (Index i = begin; i < end; ++i) {
          const Vector3 x = points[i] - frame.centroid;
          sum += x * x.transpose();
        }
        return sum;
      });
  const SymmetricEigen<3> eigen = eigen_of(scatter);
  frame.axes = eigen.vectors.rowwise().reverse();
  frame.variance = eigen.values.reverse() / count;

  const Extent extent =
      parallel_sum(context, points.size(), grain, Extent{}, [&](Index begin, Index end) {
        Extent part;
        for (Index i = begin; i < end; ++i) {
          const Vector3 x = frame.axes.transpose() * (points[i] - frame.centroid);
          part.low = part.low.cwiseMin(x);
          part.high = part.high.cwiseMax(x);
          part.skewness += x.cwiseProduct(x).cwiseProduct(x);
        }
        return part;
      });
  frame.size = (extent.high - extent.low).norm();
  frame.low = extent.low;
  frame.high = extent.high;
  for (int axis = 0; axis < 3; ++axis) {
    // Across an exact mirror the skewness is rounding, which depends on the order of the points.
    const double skewness = extent.skewness[axis] / count;
    const bool is_skew = std::abs(skewness) > single_rounding * std::pow(frame.variance[axis], 1.5);
    Index largest;
    frame.axes.col(axis).cwiseAbs().maxCoeff(&largest);
    if ((is_skew ? skewness : frame.axes(largest, axis)) >= 0) continue;
    frame.axes.col(axis) *= -1;
    frame.low[axis] = -extent.high[axis];
    frame.high[axis] = -extent.low[axis];
  }
  if (frame.size > 0) {
    frame.low /= frame.size;
    frame.high /= frame.size;
  }
  return frame;
}

}  // namespace symsurf
