#pragma once

#include <vector>

#include "symmetries/intrinsic/functional_map.h"

namespace symsurf {

/// Whether a map of a surface onto itself turns it over, as reflections do, by the products
/// df ^ dg of eigenfunctions' differentials: isometries keep them up to this sign.
class Orientation {
 public:
  Orientation(const ConnectedSurface& surface, const SurfaceBasis& basis,
              const SampledPoints& samples);

  /// The mean correlation of the products before and after: 1 for an isometry that keeps the
  /// orientation, -1 for one that reverses it; 0 without triangles. `images`: of the samples, by
  /// their positions among these.
  double of(const FunctionalMap& map, const std::vector<Index>& images) const;

 private:
  using Rows = Eigen::MatrixXd;

  // Means about each sample of the products of each pair of functions, a row a sample.
  Rows products(const Rows& functions) const;

  std::vector<Index> vertices_;    // of the triangles at samples
  std::vector<Triangles> around_;  // those of each sample, by positions among the vertices
  Rows values_;                    // of the basis, at the vertices
  Eigen::VectorXd weights_;
  Rows own_;  // products of the basis's functions
};

}  // namespace symsurf
