#pragma once

// More points than memory holds: what is left of them while they pass.

#include <symsurf/context.h>
#include <symsurf/mirror.h>
#include <symsurf/points.h>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace symsurf {

/// Any number of points in bounded memory: a grid of cubic cells, of each the number of its points
/// and their mean. The grid is the finest of edge 2^k that has at most `cells` occupied ones, so
/// far points cost a cell each and no resolution. Sums are integers, so summaries of parts add up
/// to that of the whole in any order and number of parts, to the bit.
class PointSummary {
 public:
  static constexpr Index usual_cells = 1 << 18;  ///< 30 MB; a surface of 500 x 500 cells

  /// Throws InvalidParameter for cells beyond [64, 2^28].
  explicit PointSummary(Index cells = usual_cells);
  PointSummary(const PointSummary& other);
  PointSummary(PointSummary&&) noexcept;
  PointSummary& operator=(PointSummary other) noexcept;
  ~PointSummary();

  /// Points that are not finite are counted apart. Throws InvalidInput for a coordinate beyond
  /// 1e50, and is unchanged then.
  void add(PointsView points);
  /// Throws InvalidParameter where the other has another limit of cells.
  void add(const PointSummary& other);

  Index count() const;      ///< finite points that were added
  Index nonfinite() const;  ///< the others
  Index cells() const;      ///< the limit
  Index size() const;       ///< occupied cells
  double edge() const;      ///< of a cell, input units

  /// One a cell, in lexicographic order of the cells; of a cell with one point that point itself,
  /// of others to a rounding error and 2^-64 of the power of 2^64 about them.
  Points means() const;
  /// The number of points of each, in the same order.
  Eigen::VectorX<Index> counts() const;

  /// All of it, for files and other processes: the same for the same points.
  std::vector<std::byte> bytes() const;
  /// Throws InvalidInput for bytes that are no summary's.
  static PointSummary from_bytes(std::span<const std::byte> bytes);

 private:
  struct Grid;
  std::unique_ptr<Grid> grid_;
};

/// Where the images of any points fall on a shape that is known by points spread over its surface,
/// such as PointSummary::means().
class SurfaceMatcher {
 public:
  /// The mirror must outlive it. Throws InvalidInput for fewer than 3 surface points.
  SurfaceMatcher(Points surface, const Mirror& mirror, const Context& context = {});
  SurfaceMatcher(SurfaceMatcher&&) noexcept;
  ~SurfaceMatcher();

  struct Matches {
    /// The surface point nearest to the image; -1 where that is farther than the distance allowed.
    Eigen::VectorX<Index> partners;
    /// Distance of the image from the plane through the surface points about the partner, input
    /// units; NaN without a partner.
    Eigen::VectorXd residuals;
  };
  /// One of each a point. `distance`: in input units. Throws Cancelled.
  Matches match(PointsView points, double distance, const Context& context = {}) const;

 private:
  struct Target;
  std::unique_ptr<Target> target_;
};

}  // namespace symsurf
