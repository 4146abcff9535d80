#include <algorithm>
#include <cmath>
#include <memory>

#include "base/math.h"
#include "base/parallel.h"
#include "cloud/point_tree.h"
#include "cloud/surfels.h"
#include "pairing/matching.h"
#include "published.h"
#include "score/mirror_score.h"

namespace symsurf {

namespace {

// Lengths are diagonals, as everywhere in the principal frame.
constexpr Index surfels_thinned = 500;
// When the iteration ends: by its steps, or by the change of normal and offset.
struct Rest {
  int most_steps;
  double change;
};
constexpr Rest on_thinned{30, 1e-3};
constexpr Rest on_some{50, 1e-5};
constexpr Rest on_all{100, 1e-7};        // where partners are exact they are then the final ones
constexpr Index some_points = 5000;      // of larger clouds, between the thinned one and all
constexpr double as_good = 1.5;          // times the least cost: worth going on on all points
constexpr double capped = 0.05;          // distance from which on a partner says nothing
constexpr std::size_t finalists = 3;     // planes that go on on all points
constexpr double alike_normals = 0.996;  // cosine of 5 degrees
constexpr double alike_offsets = 0.02;

struct IndexedPoints {
  Points rows;
  PointTree tree;

  IndexedPoints(Points points, const Context& context)
      : rows(std::move(points)), tree(rows, context) {}
};

std::vector<Neighbour> partners_over(const UnitPlane& plane, const IndexedPoints& points,
                                     const Context& context) {
  std::vector<Neighbour> partners(points.rows.rows());
  constexpr Index grain = 1024;
  parallel_for(context, points.tree.size(), grain, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      const std::int32_t i = points.tree.order()[k];
      partners[i] = points.tree.nearest(plane.reflect(points.rows.row(i).transpose()));
    }
  });
  return partners;
}

// Of planes, which have two signs.
double change(const UnitPlane& a, const UnitPlane& b) {
  const double sign = a.normal.dot(b.normal) < 0 ? -1 : 1;
  return (a.normal - sign * b.normal).norm() + std::abs(a.offset - sign * b.offset);
}

UnitPlane iterated(UnitPlane plane, const IndexedPoints& points, const Rest& rest,
                   const PlaneUpdate& update, const Context& context) {
  for (int k = 0; k < rest.most_steps; ++k) {
    const Context step = context.stage(1 - 1 / (1.0 + k), 1 - 1 / (2.0 + k));
    const std::vector<Neighbour> partners = partners_over(plane, points, step);
    const UnitPlane next = update({points.rows, partners}, plane);
    const double moved = change(plane, next);
    plane = next;
    if (moved <= rest.change) break;
  }
  context.report(1);
  return plane;
}

// Mean squared distance of images from their partners, capped.
double cost(const UnitPlane& plane, const IndexedPoints& points, const Context& context) {
  double sum = 0;
  for (const Neighbour& partner : partners_over(plane, points, context))
    sum += std::min(partner.squared_distance, capped * capped);
  return sum / static_cast<double>(points.rows.rows());
}

struct Candidate {
  UnitPlane plane;
  double cost;
};

void suppress_similar(std::vector<Candidate>& candidates, std::size_t most) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  suppress_non_maxima(candidates, most, [](const Candidate& a, const Candidate& b) {
    const double cosine = a.plane.normal.dot(b.plane.normal), sign = cosine < 0 ? -1 : 1;
    return std::abs(cosine) > alike_normals &&
           std::abs(a.plane.offset - sign * b.plane.offset) < alike_offsets;
  });
}

}  // namespace

Points thinned_points(const Cloud& cloud, const Context& context) {
  return cloud.patches(surfels_thinned, context).positions(surfels_thinned);
}

Result iterated_planes(const std::string& method, const Cloud& cloud, const Points& thinned,
                       const std::vector<UnitPlane>& starts, const PlaneUpdate& update,
                       const ParameterValues& values, const Context& context) {
  const auto part = [](const Context& whole, std::size_t k, std::size_t count) {
    return whole.stage(static_cast<double>(k) / static_cast<double>(count),
                       static_cast<double>(k + 1) / static_cast<double>(count));
  };
  std::vector<Candidate> candidates;
  {
    const IndexedPoints few(thinned, context.stage(0, 0));
    for (std::size_t k = 0; k < starts.size(); ++k) {
      const Context one = part(context.stage(0, 0.3), k, starts.size());
      const UnitPlane plane = iterated(starts[k], few, on_thinned, update, one.stage(0, 0.9));
      candidates.push_back({plane, cost(plane, few, one.stage(0.9, 1))});
    }
    suppress_similar(candidates, finalists);
  }
  const auto go_on = [&](const Points& points, const Rest& rest, const Context& level) {
    const IndexedPoints indexed(points, level.stage(0, 0.1));
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const Context one = part(level.stage(0.1, 1), k, candidates.size());
      UnitPlane& plane = candidates[k].plane;
      plane = iterated(plane, indexed, rest, update, one.stage(0, 0.9));
      candidates[k].cost = cost(plane, indexed, one.stage(0.9, 1));
    }
    suppress_similar(candidates, finalists);
  };
  const Points all = cloud.frame.to_frame(cloud.points, context.stage(0.3, 0.3));
  const Index stride = all.rows() / some_points;
  if (stride > 1) {
    const Points some = all(Eigen::seq(0, Eigen::last, stride), Eigen::indexing::all);
    go_on(some, on_some, context.stage(0.3, 0.4));
    const double worst = as_good * candidates.front().cost;
    std::erase_if(candidates, [&](const Candidate& c) { return c.cost > worst; });
  }
  go_on(all, on_all, context.stage(0.4, 0.8));

  std::vector<std::shared_ptr<Mirror>> mirrors;
  for (const Candidate& candidate : candidates)
    mirrors.push_back(std::make_shared<Plane>(in_input_units(candidate.plane, cloud.frame)));
  return ranked_planes(method, cloud, mirrors, values, context.stage(0.8, 1));
}

Result ranked_planes(const std::string& method, const Cloud& cloud,
                     const std::vector<std::shared_ptr<Mirror>>& planes,
                     const ParameterValues& values, const Context& context) {
  Result best = MirrorScore(cloud, context.stage(0, 0.5)).ranked(method, planes);
  add_pairs(best, cloud, values, context.stage(0.5, 1));
  return best;
}

Parameter start_normal(std::string doc) { return Parameter::direction("normal", std::move(doc)); }

std::vector<UnitPlane> given_start(const Cloud& cloud, const ParameterValues& values) {
  const Vector3& normal = values.vector("normal");
  if (normal.isZero(0)) return {};
  return {{cloud.frame.axes.transpose() * normal.stableNormalized(), 0}};
}

namespace {

// phi'(u) / u.
double wendland_slope(double u) {
  const double v = 1 - u;
  return -14 * v * v * v * v * (4 * u + 1);
}

}  // namespace

double wendland(double u) {
  if (u >= 1) return 0;
  const double v = 1 - u;
  return v * v * v * v * v * (8 * u * u + 5 * u + 1);
}

double measure_reach(PointsView points) {
  const Eigen::RowVector3d centroid = points.matrix().colwise().mean();
  const double average = (points.matrix().rowwise() - centroid).rowwise().norm().mean();
  return 2.6 * average / 15;
}

NearbyPoints::NearbyPoints(PointsView points, double reach) {
  const Vector3 low = points.matrix().colwise().minCoeff();
  const Vector3 high = points.matrix().colwise().maxCoeff();
  constexpr double most_voxels = 1 << 20;  // where an outlier spreads the grid, they grow
  const double volume = ((high - low).array() + reach).prod();
  grid_ = VoxelGrid(low.array() - reach, high.array() + reach,
                    std::max(reach, std::cbrt(volume / most_voxels)));
  lists_.resize(grid_.size());
  for (Index i = 0; i < points.size(); ++i)
    grid_.for_each_touching(grid_.index(grid_.cell_of(points[i])),
                            [&](Index voxel) { lists_[voxel].push_back(points[i]); });
}

double SymmetryMeasure::operator()(const Eigen::Vector4d& p) const {
  Eigen::Vector4d unused;
  return (*this)(p, unused);
}

double SymmetryMeasure::operator()(const Eigen::Vector4d& p, Eigen::Vector4d& gradient) const {
  const Vector3 n = p.head<3>();
  const double nn = n.squaredNorm();
  double sum = 0;
  gradient.setZero();
  for (Index i = 0; i < points_.rows(); ++i) {
    const Vector3 x = points_.row(i).transpose();
    const double l = n.dot(x) + p[3];
    const Vector3 image = x - 2 * l / nn * n;
    const std::vector<Vector3>* const nearby = nearby_(image);
    if (!nearby) continue;
    Vector3 pull = Vector3::Zero();  // gradient by the image
    for (const Vector3& y : *nearby) {
      const double u = (image - y).norm() / reach_;
      if (u >= 1) continue;
      sum += wendland(u);
      pull += wendland_slope(u) / (reach_ * reach_) * (image - y);
    }
    const double along = n.dot(pull);
    gradient.head<3>() -= 2 / nn * (along * x - 2 * l * along / nn * n + l * pull);
    gradient[3] -= 2 / nn * along;
  }
  return sum;
}

}  // namespace symsurf
