#include "symmetries/intrinsic/functional_map.h"

#include <Eigen/SVD>
#include <algorithm>
#include <limits>

#include "base/parallel.h"
#include "spatial/kd_tree.h"

namespace symsurf {

SampledFunctions::SampledFunctions(const SurfaceBasis& basis, const std::vector<Index>& vertices,
                                   Eigen::VectorXd weights)
    : values_(basis.functions(vertices, Eigen::indexing::all)), weights_(std::move(weights)) {}

std::vector<Index> SampledFunctions::images(const FunctionalMap& map) const {
  const auto functions = values_.leftCols(map.rows());
  // |f(y) - g|^2 - |g|^2, a column for each mapped g.
  const Eigen::MatrixXd mapped = (functions * map).transpose();
  Eigen::MatrixXd distances = -2 * functions * mapped;
  distances.colwise() += functions.rowwise().squaredNorm();
  std::vector<Index> nearest(values_.rows());
  for (Index i = 0; i < values_.rows(); ++i) distances.col(i).minCoeff(&nearest[i]);
  return nearest;
}

FunctionalMap SampledFunctions::fitted(const std::vector<Index>& images, Index count) const {
  const auto functions = values_.leftCols(count);
  const Eigen::MatrixXd at_images = weights_.asDiagonal() * functions(images, Eigen::indexing::all);
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(functions.transpose() * at_images,
                                           Eigen::ComputeThinU | Eigen::ComputeThinV);
  return svd.matrixU() * svd.matrixV().transpose();
}

FunctionalMap SampledFunctions::refined(std::vector<Index> from, Index first, Index last,
                                        Index step, const Context& context) const {
  FunctionalMap map;
  for (Index count = std::min(first, last);; count = std::min(count + step, last)) {
    context.check();
    map = fitted(from, count);
    if (count == last) return map;
    from = images(map);
  }
}

std::vector<Index> all_images(const SurfaceBasis& basis, const FunctionalMap& map,
                              const Context& context) {
  constexpr int dimension = 60;  // as many functions as are used, fewer filled up with zeros
  using Tree = KdTree<dimension>;
  const Index used = map.rows(), size = basis.functions.rows();
  const auto row = [&](const auto& values) {
    Tree::Point point = Tree::Point::Zero();
    point.head(used) = values.transpose();
    return point;
  };
  std::vector<Tree::Point> points;
  for (Index v = 0; v < size; ++v) points.push_back(row(basis.functions.row(v).head(used)));
  const Tree tree(std::move(points), context);
  const Eigen::MatrixXd mapped = basis.functions.leftCols(used) * map;
  std::vector<Index> images(size);
  parallel_for(context, size, 256, [&](Index begin, Index end) {
    for (Index v = begin; v < end; ++v) {
      double nearest = std::numeric_limits<double>::infinity();
      const auto offer = [&](Index image, double squared) {
        if (squared < nearest || (squared == nearest && image < images[v])) {
          nearest = squared;
          images[v] = image;
        }
        return Tree::at_most(nearest);
      };
      tree.search(row(mapped.row(v)), nearest, offer);
    }
  });
  return images;
}

}  // namespace symsurf
