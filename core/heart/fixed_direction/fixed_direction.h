#pragma once

#include <symsurf/parameter.h>
#include <symsurf/points.h>

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/math.h"
#include "cloud/point_tree.h"
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

/// A direction that more chords of the cloud share than its surroundings let expect.
struct ChordPeak {
  Vector3 direction;
  double significance;  ///< in standard deviations of a Poisson count
};

/// Peaks of the directions of the chords between points, best first.
///
/// The directions fall into the bins of a cube map; a chord counts as it crosses the surfaces at
/// its ends, cos x cos, since chords within a surface show no direction of mapping. Box sums at
/// several scales are held against the ring around them.
std::vector<ChordPeak> chord_peaks(const SurfacePoints& cloud, Index count, const Context& context);

/// The direction about `start` on which most chords agree, found by halving a cone as long as
/// its core keeps more than its share of the chords.
struct SharpDirection {
  Vector3 direction;
  double angle = 0;     ///< of the last cone, radians
  Index chords = 0;     ///< in it
  double expected = 0;  ///< chords in it, were they spread evenly over the first cone
};
SharpDirection sharpened(const SurfacePoints& cloud, const Vector3& start, double angle);

/// A direction of mapping and how it was judged.
struct DirectionCandidate {
  Vector3 direction;
  double support = 0;  ///< MidSurface::support
};

/// Directions under which a surface half-way between the surfaces has most support, best
/// first, some degrees apart: the half sphere and the given hints are tried, as far as
/// MidSurface::support_bound allows, on fewer points, then the best of them are moved uphill
/// on all.
std::vector<DirectionCandidate> supported_directions(const SurfacePoints& cloud,
                                                     const std::vector<ChordPeak>& hints,
                                                     Index count, const Context& context);

/// What is known of a surface's height at one position of the plane.
struct HeightObservation {
  Eigen::Vector2d position;
  double height;
  double weight;
};

/// Robust local quadratic regression (loess, Cleveland 1979) of heights over scattered positions.
class HeightRegression {
 public:
  /// The context, which must outlive it, is asked whether to go on.
  HeightRegression(std::vector<HeightObservation> observations, const Context& context);

  /// The positions (rows u, v, anything) with the heights fitted there, each from its `neighbours`
  /// nearest observations, tricube weights; without positions where all of these were rejected.
  Points fitted(const Points& positions, Index neighbours) const;

  /// The largest of the numbers of neighbours offered that predicts left-out observations about as
  /// well as the best does.
  Index best_neighbours(const std::vector<Index>& offered) const;

  /// Positions of observations, as rows for fitted(), no two within `distance`: heights fitted side
  /// by side differ a little, and a surface through them all would be steep between them.
  Points thinned_positions(double distance) const;

 private:
  Points positions() const;
  void nearest(const Eigen::Vector2d& position, Index neighbours,
               std::vector<Neighbour>& near) const;
  /// Height at a position from those near it, but for `left_out`; NaN where all were rejected.
  double height(const Eigen::Vector2d& position, std::span<const Neighbour> near,
                Index left_out) const;

  std::vector<HeightObservation> observations_;
  const Context& context_;
  PointTree tree_;
};

/// The surfaces of a cloud between its points: about each point a quadratic patch over its tangent
/// plane, fitted to its neighbours.
class SurfacePatches {
 public:
  SurfacePatches(const SurfacePoints& cloud, Index neighbours, const Context& context);

  /// How far x must move along the unit direction to lie on the patch about point j; NaN where the
  /// patch and the direction are nearly parallel.
  double along(Index j, const Vector3& x, const Vector3& direction) const;

  const Vector3& normal(Index j) const { return patches_[j].normal; }

 private:
  struct Patch {
    Vector3 centre, first, second, normal;  // orthonormal frame
    Eigen::Matrix<double, 6, 1> height;     // 1, a, b, a², ab, b²
    double reach;                           // beyond it the patch goes on flat
  };
  std::vector<Patch> patches_;
};

/// A height field mirror while it is searched for, in the principal frame.
struct FieldEstimate {
  Vector3 direction = Vector3::Zero();
  Points nodes;        ///< of the surface; none: nothing was found
  double support = 0;  ///< share of the displaced points that fall on the cloud, 0 to 1
};

/// Mirror, match, fit again: images over the estimate meet the surfaces on the other side, half
/// their distance along the direction is what the surface is wrong by there. What remains across
/// determines how the direction turns.
class SurfaceRefinement {
 public:
  SurfaceRefinement(const SurfacePoints& cloud, const SurfacePatches& patches,
                    const Context& context);

  /// Starts from the surface that MidSurface votes for, where `scatter` (infinity: unknown) is that
  /// of partners across the direction.
  FieldEstimate operator()(const Vector3& direction, double scatter, int rounds);

 private:
  struct Matches {
    std::vector<HeightObservation> observations;
    Eigen::Vector2d turn = Eigen::Vector2d::Zero();  // that the matches ask of the direction
    double support = 0;
  };
  Matches matches(const FieldEstimate& estimate) const;
  void refit(FieldEstimate& estimate, Matches found) const;
  FieldEstimate voted(const Vector3& direction, double scatter);

  const SurfacePoints& cloud_;
  const SurfacePatches& patches_;
  const Context context_;
  MidSurface votes_;
};

/// Finds the direction of mapping and the surface. A direction other than zero is taken as given
/// but for the last degree.
FieldEstimate find_height_field(const SurfacePoints& cloud, const Vector3& given_direction,
                                Values& statistics, const Context& context);

/// The mirror of a cloud whose points have exact partners along one direction, to rounding; an
/// estimate without nodes where they have none. Of several directions that many pairs share, as in
/// clouds on a grid, the one that meets the surfaces most squarely. `cone`: how far off, in
/// radians, the peaks may be; chords by chance hide the partners in too wide a one.
FieldEstimate exact_partners(const SurfacePoints& cloud, const std::vector<ChordPeak>& peaks,
                             double cone, const Context& context);

}  // namespace symsurf
