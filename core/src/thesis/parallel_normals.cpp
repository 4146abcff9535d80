#include "parallel_normals.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace symsurf {

namespace {

/// The normals of X2.
class NormalSearch {
 public:
  NormalSearch(PointsView normals, const std::vector<std::int32_t>& order,
               const std::vector<char>& excluded, bool as_lines)
      : as_lines_(as_lines) {
    for (const std::int32_t i : order)
      if (!excluded[i]) {
        indices_.push_back(i);
        normals_.push_back(normals[i]);
      }
    boxes_.emplace(normals_, indices_);
  }

  Index most_parallel(const Vector3& normal, Index guess_position) {
    best_ = -2;
    index_ = -1;
    consider(guess_position, normal);
    search(normal, normal);
    if (as_lines_) search(-normal, normal);
    return index_;
  }

  Index position() const { return position_; }

 private:
  // Cosines above 1 are rounding: all these angles are 0.
  void consider(Index p, const Vector3& normal) {
    const Vector3& m = normals_[p];
    double cosine = normal.x() * m.x() + normal.y() * m.y() + normal.z() * m.z();
    cosine = std::min(as_lines_ ? std::abs(cosine) : cosine, 1.0);
    if (cosine > best_ || (cosine == best_ && indices_[p] < index_)) {
      best_ = cosine;
      index_ = indices_[p];
      position_ = p;
      limit_ = 2 - 2 * best_ + 4e-15;
    }
  }

  void search(const Vector3& at, const Vector3& normal) {
    const Eigen::Vector3f q = at.cast<float>();
    const float slack = 2 * boxes_->slack();
    const auto bound = [&](const BoxTree::Boxes& boxes, BoxTree::Bounds& squared) {
      squared.fill(0);
      for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < 8; ++i) {
          const float outside =
              std::max(boxes.low[axis][i] - q[axis], q[axis] - boxes.high[axis][i]) - slack;
          squared[i] += std::max(outside, 0.0f) * std::max(outside, 0.0f);
        }
      // Among parallel normals only a lower index is better: flat patches cost no more.
      if (best_ == 1)
        for (int i = 0; i < 8; ++i)
          if (boxes.first[i] > index_) squared[i] = std::numeric_limits<float>::infinity();
    };
    boxes_->descend(bound, limit_, [&](Index begin, Index end) {
      for (Index p = begin; p < end; ++p) consider(p, normal);
    });
  }

  bool as_lines_;
  std::vector<std::int32_t> indices_;
  std::vector<Vector3> normals_;
  std::optional<BoxTree> boxes_;

  double best_ = 0, limit_ = 0;
  Index index_ = -1, position_ = 0;
};

}  // namespace

ParallelNormals::ParallelNormals(PointsView points, PointsView normals, bool as_lines)
    : points_(points), normals_(normals), as_lines_(as_lines) {
  std::vector<Vector3> places(normals.size());
  for (Index i = 0; i < normals.size(); ++i) places[i] = normals[i];
  order_ = z_order(places);
}

double ParallelNormals::projection_error(const Separation& separation) const {
  std::vector<std::int32_t> partner(points_.size(), -1);
  for (std::size_t k = 0; k < separation.upper.size(); ++k)
    partner[separation.upper[k]] = separation.partner[k];

  NormalSearch search(normals_, order_, separation.is_upper, as_lines_);
  double sum = 0;
  Index guess = 0;
  for (const std::int32_t i : order_) {
    if (partner[i] < 0) continue;
    const Index q = search.most_parallel(normals_[i], guess);
    guess = search.position();
    sum += (points_[partner[i]] - points_[q]).squaredNorm();
  }
  return sum / static_cast<double>(separation.upper.size());
}

}  // namespace symsurf
