#pragma once

#include <symsurf/types.h>

namespace symsurf {

/// n x 3 contiguous doubles that belong to somebody else, read where they lie.
class PointsView {
 public:
  PointsView() = default;
  PointsView(const double* coordinates, Index size) : data_(coordinates), size_(size) {}
  PointsView(const Points& points) : data_(points.data()), size_(points.rows()) {}

  Index size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const double* data() const { return data_; }

  Vector3 operator[](Index i) const { return {data_[3 * i], data_[3 * i + 1], data_[3 * i + 2]}; }
  Eigen::Map<const Points> matrix() const { return {data_, size_, 3}; }

 private:
  const double* data_ = nullptr;
  Index size_ = 0;
};

}  // namespace symsurf
