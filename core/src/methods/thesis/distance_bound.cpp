#include "methods/thesis/distance_bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace symsurf {

namespace {

constexpr float far = 1e12f;

// d(p) = min over q of (p - q)^2 + f(q), the lower envelope of parabolas.
void transform(std::vector<float>& f, std::vector<int>& vertex, std::vector<float>& border,
               std::vector<float>& out) {
  const int n = static_cast<int>(f.size());
  int k = 0;
  vertex[0] = 0;
  border[0] = -far;
  border[1] = far;
  const auto meeting = [&](int q, int v) {
    return ((f[q] + static_cast<float>(q * q)) - (f[v] + static_cast<float>(v * v))) /
           static_cast<float>(2 * (q - v));
  };
  for (int q = 1; q < n; ++q) {
    float s = meeting(q, vertex[k]);
    while (k > 0 && s <= border[k]) s = meeting(q, vertex[--k]);
    if (s <= border[k]) s = border[k];
    vertex[++k] = q;
    border[k] = s;
    border[k + 1] = std::numeric_limits<float>::max();
  }
  k = 0;
  for (int q = 0; q < n; ++q) {
    while (border[k + 1] < static_cast<float>(q)) ++k;
    const float d = static_cast<float>(q - vertex[k]);
    out[q] = d * d + f[vertex[k]];
  }
}

}  // namespace

DistanceBound::DistanceBound(PointsView points, const Context& context)
    : low_(points.matrix().colwise().minCoeff()) {
  const Vector3 extent = Vector3(points.matrix().colwise().maxCoeff()) - low_;
  const double thickness = 1e-2 * extent.maxCoeff();
  const double volume = extent.cwiseMax(thickness).prod();
  cell_ = std::cbrt(volume / (2 * static_cast<double>(points.size())));
  size_ = (extent / cell_).array().cast<int>() + 1;

  bound_.assign(static_cast<std::size_t>(size_.cast<Index>().prod()), far);
  interruptible_for(context, points.size(), [&](Index i) {
    bound_[index(((points[i] - low_) / cell_).array().cast<int>().min(size_ - 1))] = 0;
  });

  const std::array<Index, 3> stride{static_cast<Index>(size_.y()) * size_.z(), size_.z(), 1};
  const int longest = size_.maxCoeff();
  std::vector<int> vertex(longest);
  std::vector<float> border(longest + 1);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> line(size_[axis]), out(size_[axis]);
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    for (int i = 0; i < size_[a]; ++i)
      for (int j = 0; j < size_[b]; ++j) {
        context.check();
        float* start = &bound_[i * stride[a] + j * stride[b]];
        for (int k = 0; k < size_[axis]; ++k) line[k] = start[k * stride[axis]];
        transform(line, vertex, border, out);
        for (int k = 0; k < size_[axis]; ++k) start[k * stride[axis]] = out[k];
      }
  }
  // Cells d apart between centres hold points no nearer than d less a diagonal.
  const float diagonal = std::sqrt(3.0f) * (1 + 1e-4f);
  for (float& squared : bound_)
    squared = static_cast<float>(cell_) * std::max(0.0f, std::sqrt(squared) - diagonal);
}

}  // namespace symsurf
