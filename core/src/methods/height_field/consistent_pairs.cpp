#include "methods/height_field/consistent_pairs.h"

#include <algorithm>
#include <vector>

#include "base/math.h"
#include "base/parallel.h"
#include "score/matching.h"
#include "spatial/point_tree.h"

namespace symsurf {

namespace {

constexpr double far_residual = 6;     // median residuals: a partner by chance
constexpr double far_at_least = 1e-6;  // spacings
constexpr Index witnesses = 16;        // both ends of a pair share a surface point
constexpr double near = 2;             // spacings: an image's neighbour
constexpr double one_sided = 0.5;

// Between exact pairs the surface is known; beyond them, as at a hole's rim, it is a guess.
bool surrounded(const Vector3& x, const Points& known, const PointTree& tree,
                std::vector<Neighbour>& found) {
  tree.nearest(x, witnesses, found);
  Vector3 pull = Vector3::Zero();
  for (const Neighbour& n : found) {
    const Vector3 way = known.row(n.index).transpose() - x;
    if (way.norm() > 0) pull += way.normalized();
  }
  return pull.norm() < one_sided * static_cast<double>(found.size());
}

}  // namespace

void keep_credible_pairs(Result& result, double spacing, const Context& context) {
  const Eigen::VectorXd& residuals = result.residuals;
  if (residuals.size() == 0) return;
  const double typical = median(std::vector(residuals.begin(), residuals.end()));
  const double limit = std::max(far_residual * typical, far_at_least * spacing);
  std::vector<Index> consistent, doubtful;
  for (Index i = 0; i < residuals.size(); ++i) {
    if (residuals[i] <= limit)
      consistent.push_back(i);
    else if (residuals[i] <= near * spacing)
      doubtful.push_back(i);
  }
  if (!doubtful.empty()) {
    const Points known = result.surface_points(consistent, Eigen::indexing::all);
    const PointTree tree(known, context.stage(0, 0.5));
    std::vector<char> kept(doubtful.size());
    parallel_for(context.stage(0.5, 1), kept.size(), 1 << 10, [&](Index begin, Index end) {
      std::vector<Neighbour> found;
      for (Index k = begin; k < end; ++k)
        kept[k] = surrounded(result.surface_points.row(doubtful[k]), known, tree, found);
    });
    for (std::size_t k = 0; k < kept.size(); ++k)
      if (kept[k]) consistent.push_back(doubtful[k]);
    std::sort(consistent.begin(), consistent.end());
  }
  keep_pairs(result, consistent);
}

}  // namespace symsurf
