#include "preprocess/boundary_extraction.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "base/math.h"
#include "base/parallel.h"
#include "cloud/neighbourhood_moments.h"
#include "preprocess/volumetric.h"
#include "score/matching.h"
#include "spatial/voxel_grid.h"

namespace symsurf {

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

constexpr double rounding = 1e-6;  // diagonals: of single precision

// Share of the points whose partner is their image.
double exactly_paired(const Result& result, const Cloud& cloud) {
  const Index exact = (result.residuals.array() < rounding * cloud.diagonal).count();
  return static_cast<double>(exact) / static_cast<double>(cloud.points.size());
}

}  // namespace

std::vector<Index> boundary_of(const Cloud& cloud, const Context& context) {
  const PointTree tree(cloud.points, context);
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

bool BoundaryExtraction::needs_whole(const Cloud& cloud, const Context& context) const {
  return is_volumetric(cloud, context);
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
  pair_anew(result, whole_.points, pair_distance.value_or(rounding) * whole_.diagonal, context);
  if (result.mirror) result.score = std::max(result.score, exactly_paired(result, whole_));
  if (!pair_distance) keep_pairs(result, {});
}

}  // namespace symsurf
