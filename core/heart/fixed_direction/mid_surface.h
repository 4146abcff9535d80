#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "base/math.h"
#include "cloud/surface_points.h"

namespace symsurf {

/// The surface half-way between the surfaces of a cloud along a direction, cell by cell of the
/// projection, found by a vote: every two points that nearly lie over each other propose a height,
/// carried to the middle of the cell by the slopes of their surfaces.
class MidSurface {
 public:
  /// Kept between directions, so that trying many of them allocates nothing.
  /// Points no farther apart in projection than `reach` spacings vote.
  MidSurface(const SurfacePoints& cloud, const Context& context, double reach = 1.3);

  /// The support of the surface for this direction, 0 to 1: the share of points that
  /// it carries onto another surface, where it is smooth, each weighed by how squarely its surface
  /// meets the direction.
  /// Where partners are known to scatter across the direction by only so much, the closer they
  /// come the more they count.
  double support(const Vector3& direction,
                 double scatter = std::numeric_limits<double>::infinity());

  /// What support() cannot exceed, however well the surface fits: cheap.
  static double support_bound(const SurfacePoints& cloud, const Vector3& direction);

  /// Two points that the last direction's surface carries onto each other's surface.
  struct Chord {
    Index low, high;         ///< points, low below the surface
    Eigen::Vector2d offset;  ///< from low to high, across the direction
    double length;           ///< along it
    double weight;           ///< how squarely it meets the two surfaces, 0 to 1
  };
  std::vector<Chord> chords() const;

  /// Of the last direction: (u, v, height) a voted cell, in the frame (across, direction).
  Points cells() const;
  const Eigen::Matrix<double, 3, 2>& across() const { return across_; }

 private:
  struct Vote {
    std::int32_t first, second, cell;
    float height, weight;
  };
  // A point as the projection sees it.
  struct Position {
    double height, slope_u, slope_v, square;  // slopes of its surface, |normal . direction|
    std::int32_t point;
  };

  void project(const Vector3& direction);
  void sort_into_cells();
  void collect_votes(double scatter);
  void vote(std::int32_t p, std::int32_t begin, std::int32_t end, double narrow);
  void count_votes();
  double roughness(Index cell) const;

  const SurfacePoints& cloud_;
  const Context context_;
  Eigen::Matrix<double, 3, 2> across_;
  double reach_;
  double least_cell_, cell_;  // edges
  Eigen::Vector2d low_;       // of the grid
  Index columns_ = 0, rows_ = 0;
  Points flat_;                                      // u, v, height
  Eigen::Array<double, Eigen::Dynamic, 3> surface_;  // slope in u, in v, |normal . direction|
  std::vector<std::int32_t> start_, cell_of_;
  std::vector<double> u_, v_;        // cell by cell
  std::vector<Position> positions_;  // cell by cell
  std::vector<double> aside_;        // squared, of the points a point may meet
  std::vector<Vote> votes_;
  std::vector<std::int32_t> vote_start_, next_;
  std::vector<std::uint64_t> by_cell_;  // height and weight in order, packed
  std::vector<float> height_, smooth_;  // voted, a cell; how much its bend lets it support
  std::vector<char> voted_;
  std::vector<float> supported_;
};

/// Are there points whose partner lies just along the direction, more than chance puts there?
struct PartnerEvidence {
  Vector3 direction;        ///< moved to where most partners agree
  double significance = 0;  ///< standard deviations above chance
  double scatter = 0;       ///< of the partners across the direction, an axis
};

/// Tries scatters from a fraction of the spacing up to the surface's reach; at each, a mean shift
/// of the direction, freed of the pull of the evenly spread chance partners.
PartnerEvidence partner_evidence(const MidSurface& surface, const SurfacePoints& cloud,
                                 const Vector3& direction, const Context& context);

}  // namespace symsurf
