#include "cloud/surfels.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "cloud/point_tree.h"

namespace symsurf {

namespace {

constexpr Index points_a_task = 1 << 16;
constexpr double least_width = 1e-8;  // of the squared width against the squared length
constexpr int finest_cells = 128;     // along the longest side
// Clutter are cells with so much less than the cell of the median point, if many of those that
// touch none with more fill space, as surfaces and rods do not. Fewer than `least_around`
// points decide nothing.
constexpr double sparse = 0.05, many = 0.02, least_around = 6;
constexpr Index mostly = 2;             // filling ones for one that is thin
constexpr double thin_variance = 0.06;  // of that along the longest direction

// How many points, their sum, and that of their products: side by side, to be added at once.
struct Moments {
  Eigen::Matrix<double, 10, 1> sums = Eigen::Matrix<double, 10, 1>::Zero();

  Moments& operator+=(const Moments& other) {
    sums += other.sums;
    return *this;
  }
  void add(const Vector3& x) {
    sums[0] += 1;
    sums.segment<3>(1) += x;
    sums.segment<3>(4) += x.x() * x;
    sums.segment<2>(7) += x.y() * x.tail<2>();
    sums[9] += x.z() * x.z();
  }
  double count() const { return sums[0]; }
  Vector3 mean() const { return sums.segment<3>(1) / count(); }
  Matrix3 covariance() const {
    Matrix3 s;
    s << sums[4], sums[5], sums[6], sums[5], sums[7], sums[8], sums[6], sums[8], sums[9];
    return s / count() - mean() * mean().transpose();
  }
};

bool is_thin(const Matrix3& covariance) {
  const LeastEigen spread = least_eigen_of(covariance);
  return spread.value < thin_variance * spread.greatest;
}

// How many share the group of the median member.
double size_of_median_group(std::vector<double> sizes) {
  std::sort(sizes.begin(), sizes.end());
  const double half = std::accumulate(sizes.begin(), sizes.end(), 0.0) / 2;
  double passed = 0;
  auto size = sizes.begin();
  while ((passed += *size) < half) ++size;
  return *size;
}

struct Thinnest {
  Vector3 direction;
  double flatness, thickness, width;
};

Thinnest thinnest_direction(const Matrix3& covariance) {
  const LeastEigen spread = least_eigen_of(covariance);
  if (!(spread.next > least_width * spread.greatest)) return {spread.vector, 0, 0, 0};
  // A root at zero would make rounding a hundred million times as large as it is.
  constexpr double rounded_off = 1e-8;
  const double least = spread.value / spread.next;
  const double thickness = std::sqrt(least + rounded_off) - std::sqrt(rounded_off);
  return {spread.vector, std::max(0.0, 1 - thickness), std::sqrt(spread.value),
          std::sqrt(spread.next)};
}

}  // namespace

double Surfel::flatness_without(double noise) const {
  const double thin = thickness * thickness - noise * noise, wide = width * width - noise * noise;
  return wide > 0 ? std::max(flatness, 1 - std::sqrt(std::max(0.0, thin) / wide)) : flatness;
}

Vector3 Surfel::smoothed(const Vector3& x, double width) const {
  const double narrow = width * width * width * width;
  Matrix3 widened = covariance * covariance;
  widened.diagonal().array() += narrow;
  return x - narrow * (widened.inverse() * (x - mean));
}

// What is known of the points of a cell.
struct Surfels::Patch {
  VoxelGrid::Cell cell = VoxelGrid::Cell::Zero();
  Moments moments;
  Neighbour nearest;  // to the middle of the cell
  Vector3 sampled = Vector3::Zero();

  void sample(const Neighbour& candidate, const Vector3& x) {
    if (!(candidate < nearest)) return;
    nearest = candidate;
    sampled = x;
  }
};

Surfels::Surfels(const Cloud& cloud, Index count, const Context& context)
    : Surfels(cloud, count, std::nullopt, 0, context) {}

Surfels::Surfels(const Cloud& cloud, const Surfels& coarser, const Context& context)
    : Surfels(cloud, 4 * coarser.count_, coarser.uncluttered_, coarser.spacing() / 2, context) {}

Surfels::Surfels(const Cloud& cloud, Index count, std::optional<OccupiedVoxels> uncluttered,
                 double guess, const Context& context)
    : count_(count), uncluttered_(std::move(uncluttered)) {
  // More than one point a cell: alone it determines no patch.
  const double wanted =
      std::min(static_cast<double>(count_), 0.7 * static_cast<double>(cloud.points.size()));
  choose_cell(cloud, wanted, guess, context.stage(0, 0.5));
  std::vector<Patch> patches = patches_of(cloud, context.stage(0.5, 1));
  // Without the clutter, cells are smaller, and what is clutter is seen better.
  constexpr int most = 3;
  for (int k = 0; k < most && drop_clutter(patches); ++k) {
    const double kept = static_cast<double>(patches.size()) / wanted;
    choose_cell(cloud, wanted, grid_.edge() * std::sqrt(kept), context.stage(1, 1));
    patches = patches_of(cloud, context.stage(1, 1));
  }
  make_surfels(patches);
}

Points Surfels::positions(Index count) const {
  const Index stride = std::max<Index>(1, size() / count);
  Points positions((size() + stride - 1) / stride, 3);
  for (Index i = 0; i < positions.rows(); ++i)
    positions.row(i) = surfels_[i * stride].position.transpose();
  return positions;
}

// Surfaces fill cells as the square of the resolution, so two or three guesses are enough. The
// first is that edge of a cell, where it is given.
void Surfels::choose_cell(const Cloud& cloud, double wanted, double guess, const Context& context) {
  const double longest = (cloud.frame.high - cloud.frame.low).maxCoeff();
  double cells =
      std::min<double>(finest_cells, guess > 0 ? longest / guess : 1 + std::sqrt(wanted));
  constexpr int guesses = 4;
  for (int k = 0; k < guesses; ++k) {
    grid_ = OccupiedVoxels(VoxelGrid(cloud.frame.low, cloud.frame.high, longest / cells));
    for (Index i = 0; i < cloud.points.size(); ++i) {
      const Vector3 x = cloud.frame.to_frame(cloud.points[i]);
      if (!is_clutter(x)) grid_.occupy(grid_.cell_of(x));
    }
    grid_.number_them();
    const double occupied = static_cast<double>(grid_.count());
    context.report((k + 1.0) / guesses);
    const double better = std::min<double>(finest_cells, cells * std::sqrt(wanted / occupied));
    if (std::abs(occupied / wanted - 1) < 0.15 || std::abs(better - cells) < 0.5) return;
    cells = better;
  }
}

std::vector<Surfels::Patch> Surfels::patches_of(const Cloud& cloud, const Context& context) const {
  std::vector<Patch> patches(grid_.count());
  for (Index i = 0; i < cloud.points.size(); ++i) {
    const Vector3 x = cloud.frame.to_frame(cloud.points[i]);
    if (is_clutter(x)) continue;
    const VoxelGrid::Cell c = grid_.cell_of(x);
    Patch& patch = patches[grid_.number(c)];
    patch.cell = c;
    patch.moments.add(x - grid_.low());
    patch.sample({i, (x - grid_.middle(c)).squaredNorm()}, x);
    if (i % points_a_task == 0)
      context.report(static_cast<double>(i) / static_cast<double>(cloud.points.size()));
  }

  std::erase_if(patches, [](const Patch& patch) { return patch.moments.count() == 0; });
  return patches;
}

// Whether there was any.
bool Surfels::drop_clutter(std::vector<Patch>& patches) {
  std::vector<double> counts;
  for (const Patch& patch : patches) counts.push_back(patch.moments.count());
  const double least = sparse * size_of_median_group(std::move(counts));
  const auto is_dense = [&](const Patch& patch) { return patch.moments.count() >= least; };
  if (std::all_of(patches.begin(), patches.end(), is_dense)) return false;

  Index filling = 0, thin = 0;
  for (const Patch& patch : patches) {
    if (is_dense(patch)) continue;
    bool apart = true;
    Moments around;
    grid_.for_each_occupied_touching(patch.cell, [&](Index other) {
      apart = apart && !is_dense(patches[other]);
      around += patches[other].moments;
    });
    if (apart && around.count() >= least_around) ++(is_thin(around.covariance()) ? thin : filling);
  }
  if (static_cast<double>(filling) < many * static_cast<double>(patches.size())) return false;
  if (filling < mostly * thin) return false;

  std::erase_if(patches, std::not_fn(is_dense));
  grid_ = OccupiedVoxels(VoxelGrid(grid_));  // none of them occupied
  for (const Patch& patch : patches) grid_.occupy(patch.cell);
  grid_.number_them();
  uncluttered_ = grid_;
  return true;
}

void Surfels::make_surfels(const std::vector<Patch>& patches) {
  surfels_.reserve(patches.size());
  for (const Patch& patch : patches) {
    Moments around;
    grid_.for_each_occupied_touching(patch.cell, [&](Index k) { around += patches[k].moments; });
    const Matrix3 covariance = around.covariance();
    const Thinnest thinnest = thinnest_direction(covariance);
    surfels_.push_back({{thinnest.direction, thinnest.flatness},
                        grid_.low() + patch.moments.mean(),
                        thinnest.thickness,
                        thinnest.width,
                        patch.sampled,
                        patch.moments.count(),
                        grid_.low() + around.mean(),
                        covariance});
  }
}

const Surfel* flattest_at(std::initializer_list<const Surfels*> scales, const Vector3& x) {
  constexpr double by_chance = 0.1;  // few points look flatter than they are
  const Surfel* flattest = nullptr;
  for (const Surfels* surfels : scales) {
    const Index i = surfels->containing(x);
    if (i < 0) continue;
    const Surfel& surfel = (*surfels)[i];
    if (!flattest || surfel.flatness > flattest->flatness + by_chance) flattest = &surfel;
  }
  return flattest;
}

SurfelMap::SurfelMap(const Surfels& surfels) : surfels_(surfels) {
  constexpr int steps = 2;            // how far a surfel reaches, in voxels
  constexpr double refinement = 1.5;  // voxels along a cell of the surfels
  const double edge = surfels.spacing() / refinement, reach = steps * edge;
  Vector3 low = Vector3::Constant(infinity), high = -low;
  for (Index i = 0; i < surfels.size(); ++i) {
    low = low.cwiseMin(surfels[i].position);
    high = high.cwiseMax(surfels[i].position);
  }
  grid_ = VoxelGrid::from_corner(low.array() - reach, high.array() + reach, edge);
  near_.assign(grid_.size(), -1);
  std::vector<float> distance(near_.size(), static_cast<float>(reach * reach));
  for (Index i = 0; i < surfels.size(); ++i) {
    const Vector3& x = surfels[i].position;
    grid_.for_each_row_around(grid_.cell_of(x), steps, [&](Index begin, Index end) {
      VoxelGrid::Cell cell = grid_.cell(begin);
      for (Index voxel = begin; voxel < end; ++voxel, ++cell.z()) {
        const auto squared = static_cast<float>((grid_.middle(cell) - x).squaredNorm());
        if (squared >= distance[voxel]) continue;
        distance[voxel] = squared;
        near_[voxel] = static_cast<std::int32_t>(i);
      }
    });
  }
}

namespace {

constexpr double width = 2;  // of a surface with noise, over the noise's deviation

}  // namespace

std::vector<Vector3> neighbours_of(const std::vector<OnSurface>& samples,
                                   const PrincipalFrame& frame, const NearestPoints& points) {
  std::vector<Vector3> positions;
  for (const OnSurface& s : samples) positions.push_back(frame.from_frame(s.position));
  std::vector<Vector3> neighbours = points.second_nearest(positions);
  for (Vector3& x : neighbours) x = frame.to_frame(x);
  return neighbours;
}

SurfaceNoise::SurfaceNoise(const std::vector<OnSurface>& samples,
                           const std::vector<Vector3>& neighbours) {
  constexpr double shown = 0.67;  // of it, in the median
  if (samples.empty()) return;
  std::vector<double> offsets;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const Vector3 chord = neighbours[k] - samples[k].position;
    offsets.push_back(std::abs(chord.dot(samples[k].surfel->normal)));
  }
  deviation_ = median(std::move(offsets)) / shown;
}

bool SurfaceNoise::shows() const {
  constexpr double noticed = 0.002;
  return deviation_ > noticed;
}

Vector3 SurfaceNoise::smoothed(const Vector3& x, const Surfel& patch) const {
  return shows() ? patch.smoothed(x, width * deviation_) : x;
}

}  // namespace symsurf
