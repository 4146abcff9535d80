#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "cloud/voxel_grid.h"

namespace symsurf {

/// The plane through a patch of the cloud.
struct Facet {
  Vector3 normal;   ///< unit, sign arbitrary
  double flatness;  ///< 1: the patch is a surface, 0: a blob or a line, without a normal
};

/// A patch of the cloud: the points of one voxel, as their mean, and with the cells around as
/// their plane. All in the principal frame.
struct Surfel : Facet {
  Vector3 position;
  double thickness, width;  ///< standard deviations along the thinnest direction and the next
  Vector3 sampled;          ///< the cloud's point nearest to the middle of the cell
  double count;             ///< points of the cell
  Vector3 mean;             ///< of the points of the cells around
  Matrix3 covariance;       ///< theirs

  /// What the flatness would be without noise of that standard deviation.
  double flatness_without(double noise) const;

  /// x moved towards the mean along directions in which the patch spreads less than `width`:
  /// x - w^4 (C^2 + w^4)^-1 (x - mean), as Butterworth's filter parts low frequencies from high.
  Vector3 smoothed(const Vector3& x, double width) const;
};

/// The cloud thinned to about `count` surfels. Moments are summed cell by cell, so noise averages
/// out, density hardly counts and 10^6 points cost one pass. Clutter, where a dense cloud has next
/// to no points in many cells, makes none.
class Surfels {
 public:
  Surfels(const Cloud& cloud, Index count, const Context& context);

  /// About four times as many. What was clutter there is clutter here.
  Surfels(const Cloud& cloud, const Surfels& coarser, const Context& context);

  Index size() const { return static_cast<Index>(surfels_.size()); }
  const Surfel& operator[](Index i) const { return surfels_[i]; }

  /// Where every k-th of them lies, about `count` in all.
  Points positions(Index count) const;

  /// Edge of a cell, about the distance between surfels.
  double spacing() const { return grid_.edge(); }

  /// The same of that many points, all the cloud has: on a surface.
  double spacing_of(Index points) const {
    return spacing() * std::sqrt(static_cast<double>(size()) / static_cast<double>(points));
  }

  /// The surfel of the cell that holds x, -1 where the cell has none or x lies outside the grid.
  Index containing(const Vector3& x) const { return grid_.number_at(x); }

 private:
  struct Patch;

  Surfels(const Cloud& cloud, Index count, std::optional<OccupiedVoxels> uncluttered, double guess,
          const Context& context);
  bool is_clutter(const Vector3& x) const { return uncluttered_ && uncluttered_->number_at(x) < 0; }
  void choose_cell(const Cloud& cloud, double wanted, double guess, const Context& context);
  std::vector<Patch> patches_of(const Cloud& cloud, const Context& context) const;
  bool drop_clutter(std::vector<Patch>& patches);
  void make_surfels(const std::vector<Patch>& patches);

  Index count_;  // that was asked for
  OccupiedVoxels grid_;
  std::optional<OccupiedVoxels> uncluttered_;  // a coarser one, what is outside of which is clutter
  std::vector<Surfel> surfels_;                // one an occupied cell
};

/// The flattest of the surfels whose cells hold x; of nearly equal ones the first.
const Surfel* flattest_at(std::initializer_list<const Surfels*> scales, const Vector3& x);

/// Which surfel lies nearest to any position, to half a cell: one look-up instead of a search.
class SurfelMap {
 public:
  /// The surfels must outlive it.
  explicit SurfelMap(const Surfels& surfels);

  const Surfel& operator[](Index i) const { return surfels_[i]; }

  /// The surfel nearest to x, or -1 when none lies within about a cell and a half of it.
  Index nearest(const Vector3& x) const {
    const Index voxel = grid_.index_at(x);
    return voxel < 0 ? -1 : near_[voxel];
  }

 private:
  const Surfels& surfels_;
  VoxelGrid grid_;
  std::vector<std::int32_t> near_;  // by voxel
};

/// A point of a cloud and the patch of its surface, in the principal frame.
struct OnSurface {
  Vector3 position;
  const Surfel* surfel;
};

/// The points nearest but one to them, in the principal frame.
std::vector<Vector3> neighbours_of(const std::vector<OnSurface>& samples,
                                   const PrincipalFrame& frame, const NearestPoints& points);

/// The noise that takes a cloud's points off its surfaces, and points without it.
class SurfaceNoise {
 public:
  SurfaceNoise() = default;

  /// From how far neighbours lie off the samples' surfaces; none where there are no samples. Being
  /// near, they have much of their noise in common.
  SurfaceNoise(const std::vector<OnSurface>& samples, const std::vector<Vector3>& neighbours);

  /// Standard deviation, over the cloud's size.
  double deviation() const { return deviation_; }

  /// Is it more than what curvature between neighbours makes?
  bool shows() const;

  /// Where noise shows, x moved onto what its patch has in common. What spreads little more than
  /// the noise, as small patches do across their surface, is taken for noise as well.
  Vector3 smoothed(const Vector3& x, const Surfel& patch) const;

 private:
  double deviation_ = 0;
};

}  // namespace symsurf
