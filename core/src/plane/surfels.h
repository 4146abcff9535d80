#pragma once

#include <symsurf/method.h>

#include <cmath>
#include <initializer_list>
#include <vector>

#include "../occupied_cells.h"

namespace symsurf {

/// The plane through a patch of the cloud.
struct Facet {
  Vector3 normal;   ///< unit, sign arbitrary
  double flatness;  ///< 1: the patch is a sheet, 0: a blob or a line, without a normal
};

/// A patch of the cloud: the points of one grid cell, as their mean, and with the cells around as
/// their plane. All in the principal frame.
struct Surfel : Facet {
  Vector3 position;
  double thickness, width;  ///< standard deviations along the thinnest direction and the next
  Vector3 sampled;          ///< the cloud's point nearest to the middle of the cell
  Vector3 mean;             ///< of the points of the cells around
  Matrix3 covariance;       ///< theirs

  /// What the flatness would be without noise of that standard deviation.
  double flatness_without(double noise) const;

  /// x moved towards the mean along directions in which the patch spreads less than `width`:
  /// x - w^4 (C^2 + w^4)^-1 (x - mean), as Butterworth's filter parts low frequencies from high.
  Vector3 smoothed(const Vector3& x, double width) const;
};

/// The cloud thinned to about `count` surfels. Moments are summed cell by cell, so noise averages
/// out, density hardly counts and 10^6 points cost one pass.
class Surfels {
 public:
  Surfels(const Cloud& cloud, Index count, const Context& context);

  /// About four times as many.
  Surfels(const Cloud& cloud, const Surfels& coarser, const Context& context);

  Index size() const { return static_cast<Index>(surfels_.size()); }
  const Surfel& operator[](Index i) const { return surfels_[i]; }

  /// Where every k-th of them lies, about `count` in all.
  Points positions(Index count) const;

  /// Edge of a cell, about the distance between surfels.
  double spacing() const { return cell_; }

  /// The same of that many points, all the cloud has: on a sheet.
  double spacing_of(Index points) const {
    return cell_ * std::sqrt(static_cast<double>(size()) / static_cast<double>(points));
  }

  /// The surfel of the cell that holds x, -1 where the cell is empty or x lies outside the grid.
  Index containing(const Vector3& x) const;

 private:
  using Cell = Eigen::Vector3i;
  struct Patch;

  Surfels(const Cloud& cloud, Index count, double guess, const Context& context);
  void choose_cell(const Cloud& cloud, double guess, const Context& context);
  void sum_moments(const Cloud& cloud, const Context& context);
  void join(std::vector<Patch>& patches, const Context& context);
  Cell cell_of(const Vector3& x) const {
    return ((x - low_) * cells_).cast<int>().cwiseMax(0).cwiseMin(size_ - Cell::Ones());
  }
  Index linear(const Cell& c) const {
    return (static_cast<Index>(c.x()) * size_.y() + c.y()) * size_.z() + c.z();
  }

  Index count_;  // that was asked for
  Vector3 low_;
  double cell_ = 1, cells_ = 1;  // edge of a cell, cells along a unit of length
  Cell size_;
  OccupiedCells occupied_;
  std::vector<Surfel> surfels_;  // one each
};

/// The flattest of the surfels whose cells hold x; of nearly equal ones the first.
const Surfel* flattest_at(std::initializer_list<const Surfels*> scales, const Vector3& x);

}  // namespace symsurf
