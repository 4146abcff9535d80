#include "symmetries/intrinsic/orientation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/math.h"

namespace symsurf {

namespace {

constexpr Index most_functions = 10;  // whose products are compared

}  // namespace

Orientation::Orientation(const ConnectedSurface& surface, const SurfaceBasis& basis,
                         const SampledPoints& samples)
    : weights_(samples.weights) {
  std::vector<Index> sample_of(surface.points.rows(), -1), position(surface.points.rows(), -1);
  for (std::size_t s = 0; s < samples.vertices.size(); ++s)
    sample_of[samples.vertices[s]] = static_cast<Index>(s);
  std::vector<std::vector<std::array<Index, 3>>> around(samples.vertices.size());
  for (Index t = 0; t < surface.triangles.rows(); ++t)
    for (int c = 0; c < 3; ++c) {
      const Index sample = sample_of[surface.triangles(t, c)];
      if (sample < 0) continue;
      std::array<Index, 3>& corners = around[sample].emplace_back();
      for (int k = 0; k < 3; ++k) {
        Index& at = position[surface.triangles(t, k)];
        if (at < 0) {
          at = static_cast<Index>(vertices_.size());
          vertices_.push_back(surface.triangles(t, k));
        }
        corners[k] = at;
      }
    }
  for (const auto& triangles : around) around_.push_back(rows_of(triangles));
  values_ = basis.functions(vertices_, Eigen::indexing::all);
  own_ = products(values_.leftCols(std::min(most_functions, values_.cols())));
}

Orientation::Rows Orientation::products(const Rows& functions) const {
  const Index count = functions.cols();
  Rows means = Rows::Zero(static_cast<Index>(around_.size()), count * (count - 1) / 2);
  for (Index s = 0; s < means.rows(); ++s) {
    for (Index t = 0; t < around_[s].rows(); ++t) {
      const auto corners = around_[s].row(t);
      const Eigen::RowVectorXd one = functions.row(corners[1]) - functions.row(corners[0]);
      const Eigen::RowVectorXd other = functions.row(corners[2]) - functions.row(corners[0]);
      Index pair = 0;
      for (Index f = 0; f < count; ++f)
        for (Index g = 0; g < f; ++g) means(s, pair++) += one[f] * other[g] - one[g] * other[f];
    }
    if (around_[s].rows() > 0) means.row(s) /= static_cast<double>(around_[s].rows());
  }
  return means;
}

double Orientation::of(const FunctionalMap& map, const std::vector<Index>& images) const {
  const Index count = std::min({most_functions, values_.cols(), map.cols()});
  const Rows mapped = products(values_.leftCols(map.rows()) * map.leftCols(count));
  double sum = 0;
  for (Index pair = 0; pair < mapped.cols(); ++pair) {
    const Eigen::VectorXd here = mapped.col(pair), there = own_(images, pair);
    const double squares = weights_.dot(here.cwiseAbs2()) * weights_.dot(there.cwiseAbs2());
    if (squares > 0) sum += weights_.dot(here.cwiseProduct(there)) / std::sqrt(squares);
  }
  return mapped.cols() == 0 ? 0 : sum / static_cast<double>(mapped.cols());
}

}  // namespace symsurf
