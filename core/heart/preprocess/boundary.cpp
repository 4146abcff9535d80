#include "preprocess/boundary.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>
#include <vector>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "cloud/surface_points.h"
#include "cloud/voxel_grid.h"
#include "pairing/matching.h"

namespace symsurf {

namespace {

// A sample of the points decides whether a cloud is volumetric: first a few, as most are not. The
// roundness, squared thickness over squared length of the neighbourhood of a point, is .3 to .35
// within bodies, in the median, and less on surfaces, unless noise as large as their points'
// spacing blurs them.
struct Effort {
  Index sampled, queried;
};
constexpr Effort rough{600, 128}, close{8192, 768};
constexpr Index near = 16, least_sampled = 400;
constexpr double roughly_round = 0.22, round = 0.29;
// The same of fewer neighbours, .19 to .2 within bodies, distinguishes surfaces near each other.
constexpr Index nearest = 8;
constexpr double closely_round = 0.17;
// Such noise shows by the share of points with neighbours on one side, most of them sparse, while
// bodies end abruptly: .14 to .2 of bodies, above .28 of noisy surfaces.
constexpr double aside = 0.25, thin = 0.3, abrupt = 0.235;
constexpr double vicinity = 0.08;  // of the cloud's size: what density is compared in

Points sampled_of(const Cloud& cloud, Index wanted, const Context& context) {
  const double share =
      std::min(1.0, static_cast<double>(wanted) / static_cast<double>(cloud.points.size()));
  std::vector<Vector3> chosen;
  interruptible_for(context, cloud.points.size(), [&](Index i) {
    const Vector3 x = cloud.points[i];
    if (is_chosen(hash_of(x), share)) chosen.push_back(x);
  });
  return rows_of(chosen);
}

// Some of the cloud's points, and their neighbourhoods.
class Sample {
 public:
  Sample(const Cloud& cloud, const Effort& effort, const Context& context)
      : effort_(effort),
        points_(sampled_of(cloud, effort.sampled, context)),
        vicinity_(vicinity * cloud.frame.size),
        context_(context),
        tree_(points_) {}

  bool is_enough() const { return points_.rows() >= least_sampled; }

  struct Look {
    double roundness;  // in the median
    double one_sided;  // the share of points with others on one side
  };

  // By the k nearest of each point.
  Look look(Index k) const {
    const auto looks =
        of_surroundings<Look>(k, effort_.queried, [](const NeighbourhoodMoments& around) {
          const LeastEigen spread = least_eigen_of(around.covariance);
          return Look{spread.value / spread.greatest, around.one_sided() > aside ? 1.0 : 0.0};
        });
    std::vector<double> roundness;
    double one_sided = 0;
    for (const Look& look : looks) {
      roundness.push_back(look.roundness);
      one_sided += look.one_sided;
    }
    return {median(std::move(roundness)), one_sided / static_cast<double>(looks.size())};
  }

  // The share of points that are sparse, compared with those in the vicinity.
  double sparse_share() const {
    const auto densities =
        of_surroundings<double>(near, points_.rows(), [](const NeighbourhoodMoments& around) {
          return 1 / (around.radius * around.radius * around.radius);
        });
    std::vector<double> density(densities.size());
    for (std::size_t v = 0; v < density.size(); ++v) density[tree_.order()[v]] = densities[v];
    double looked = 0, found = 0;
    for (Index i = 0; i < points_.rows(); i += stride(effort_.queried)) {
      double sum = 0, count = 0;
      tree_.within(points_.row(i), vicinity_, [&](Index k, double) {
        sum += density[k];
        count += 1;
      });
      looked += 1;
      found += density[i] * count < thin * sum;
    }
    return found / looked;
  }

 private:
  Index stride(Index wanted) const { return std::max<Index>(1, points_.rows() / wanted); }

  // value(surroundings) of about as many points as wanted, in the tree's order.
  template <typename T, typename Value>
  std::vector<T> of_surroundings(Index k, Index wanted, const Value& value) const {
    std::vector<Index> positions;
    for (Index position = 0; position < points_.rows(); position += stride(wanted))
      positions.push_back(position);
    std::vector<T> values(positions.size());
    visit_neighbourhoods(
        points_, tree_, k, positions, context_,
        [&](Index v, const NeighbourhoodMoments& around) { values[v] = value(around); });
    return values;
  }

  Effort effort_;
  Points points_;
  double vicinity_;
  const Context& context_;
  PointTree tree_;
};

}  // namespace

bool is_volumetric(const Cloud& cloud, const Context& context) {
  const Sample few(cloud, rough, context);
  if (!few.is_enough() || !(few.look(near).roundness > roughly_round)) return false;
  const Sample many(cloud, close, context);
  const auto [roundness, one_sided] = many.look(near);
  return roundness > round && one_sided < abrupt && many.look(nearest).roundness > closely_round &&
         one_sided + 2 * many.sparse_share() < abrupt;
}

namespace {

// What makes a point one of the boundary, by so many neighbours: of those inside hardly one in a
// hundred has as many on one side.
constexpr Index neighbours = 48;
constexpr double one_sided = 0.21;

// Positions in the tree's order of the points that may be boundary: of a large cloud not those of
// cells among others that hold as many points as most.
std::vector<Index> outer_positions(const Cloud& cloud, const PointTree& tree,
                                   const Context& context) {
  constexpr Index large = 20000;
  constexpr double in_cell = 16, full = 0.5;  // of the median cell
  std::vector<Index> positions(cloud.points.size());
  std::iota(positions.begin(), positions.end(), 0);
  if (cloud.points.size() < large) return positions;

  const PrincipalFrame& frame = cloud.frame;
  const double volume = (frame.high - frame.low).prod() / static_cast<double>(positions.size());
  const VoxelGrid grid(frame.low, frame.high, std::cbrt(in_cell * volume));
  const auto voxel_of = [&](Index i) {
    return grid.index(grid.cell_of(frame.to_frame(cloud.points[i])));
  };
  std::vector<Index> held(grid.size()), occupied;
  interruptible_for(context, cloud.points.size(), [&](Index i) { ++held[voxel_of(i)]; });
  std::copy_if(held.begin(), held.end(), std::back_inserter(occupied),
               [](Index n) { return n > 0; });
  const double least = full * static_cast<double>(median(std::move(occupied)));
  std::vector<char> deep(grid.size());
  interruptible_for(context, grid.size(), [&](Index voxel) {
    int full_around = 0;
    grid.for_each_touching(voxel,
                           [&](Index k) { full_around += static_cast<double>(held[k]) >= least; });
    deep[voxel] = full_around == 27;
  });
  std::erase_if(positions, [&](Index position) { return deep[voxel_of(tree.order()[position])]; });
  return positions;
}

// Share of the points whose partner is their image.
double exactly_paired(const Result& result, const Cloud& cloud) {
  const Index exact = (result.residuals.array() < single_rounding * cloud.diagonal).count();
  return static_cast<double>(exact) / static_cast<double>(cloud.points.size());
}

}  // namespace

std::vector<Index> boundary_of(const Cloud& cloud, const Context& context) {
  const PointTree& tree = cloud.tree(context);
  const std::vector<Index> positions = outer_positions(cloud, tree, context);
  std::vector<char> is_boundary(positions.size());
  visit_neighbourhoods(cloud.points, tree, neighbours, positions, context,
                       [&](Index v, const NeighbourhoodMoments& around) {
                         is_boundary[v] = around.one_sided() > one_sided;
                       });
  std::vector<Index> boundary;
  for (std::size_t v = 0; v < positions.size(); ++v)
    if (is_boundary[v]) boundary.push_back(tree.order()[positions[v]]);
  std::sort(boundary.begin(), boundary.end());
  return boundary;
}

bool BoundaryExtraction::apply(Cloud& cloud, const Context& context) {
  if (!is_volumetric(cloud, context)) return false;
  if (keep_interior_ && keep_interior_(cloud, values_, context)) return false;
  const std::vector<Index> boundary = boundary_of(cloud, context);
  count_ = static_cast<Index>(boundary.size());
  if (count_ < minimum_points_) return false;
  whole_ = cloud;
  keep(cloud, boundary);
  return true;
}

void BoundaryExtraction::map_back(Result& result, PairDistance pair_distance,
                                  const Context& context) const {
  result.statistics["boundary_points"] = count_;
  pair_anew(result, whole_, pair_distance.value_or(single_rounding) * whole_.diagonal, context);
  if (result.mirror) result.score = std::max(result.score, exactly_paired(result, whole_));
  if (!pair_distance) keep_pairs(result, {});
}

}  // namespace symsurf
