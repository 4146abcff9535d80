#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "cloud/surface_points.h"

namespace symsurf {

/// Diagonals: what single precision makes of coordinates.
inline constexpr double coordinate_rounding = 1e-7;

/// Standard deviations of the noise that a piece may lie off the plane of a facet that takes it.
inline constexpr double in_plane = 2.5;

/// Of a facet's area: what it must keep where larger ones take from it, and growth by which its
/// plane is fitted again.
inline constexpr double least_left = 0.5, refitted = 1.2;

/// Moments up to the second, about the origin, of pieces of a surface.
struct SurfaceMoments {
  double area = 0, pieces = 0;
  Vector3 sum = Vector3::Zero();
  Matrix3 products = Matrix3::Zero();

  /// Of a point of area 1.
  static SurfaceMoments of_point(const Vector3& x);
  static SurfaceMoments of_triangle(const Vector3& a, const Vector3& b, const Vector3& c);

  SurfaceMoments& operator+=(const SurfaceMoments& other);
  Vector3 centroid() const { return sum / area; }
  Matrix3 scatter() const { return products - sum * sum.transpose() / area; }
};

/// The plane through a piece of surface, by principal components.
struct FacetPlane {
  Vector3 centroid = Vector3::Zero(), normal = Vector3::Zero();
  /// Radians that noise turns it by, for each unit of the noise.
  double turned = 0;
};
FacetPlane plane_of(const SurfaceMoments& moments);

/// Of each group the pieces in it, ascending; -1: in none.
std::vector<std::vector<Index>> members_of(const std::vector<Index>& group);

using Adjacency = std::vector<std::pair<Index, Index>>;

/// Pieces of a surface: their moments, the points that each has, and which touch.
struct SurfacePieces {
  std::vector<SurfaceMoments> moments;
  std::vector<std::vector<Index>> points;
  Adjacency adjacent;
};

/// Pieces of surface merged into nearly flat facets, the flattest pairs first (Garland, Willmott
/// and Heckbert 2001): the number of the facet of each piece. `noise`: standard deviation of the
/// points, which tells what is flat.
std::vector<Index> facets_of(PointsView points, const SurfacePieces& pieces, double noise,
                             const Context& context);

/// Standard deviation of the noise of the points of a surface, from quadrics fitted to the flattest
/// patches. 0 where no patch has enough points.
double noise_of(PointsView points, const SurfacePieces& pieces, const Context& context);

/// Great facets take pieces of lesser ones, or of none, that lie in their planes and go on from
/// theirs. What has lost much is taken apart. `facet`: of each piece the number of its facet, -1:
/// none. Pieces has
///   SurfaceMoments moments(Index piece) const,
///   bool is_in(const FacetPlane&, Index piece) const,
///   void for_each_next(Index piece, visit) const, which calls visit(next).
template <typename Pieces>
std::vector<Index> great_facets(const Pieces& pieces, std::vector<Index> facet,
                                const Context& context) {
  const std::vector<std::vector<Index>> members = members_of(facet);
  std::vector<double> area(members.size(), 0);
  for (std::size_t own = 0; own < members.size(); ++own)
    for (const Index piece : members[own]) area[own] += pieces.moments(piece).area;
  std::vector<Index> order(members.size()), rank(members.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return area[a] > area[b]; });
  for (std::size_t k = 0; k < order.size(); ++k) rank[order[k]] = static_cast<Index>(k);
  for (const Index own : order) {
    std::vector<Index> open;
    SurfaceMoments held;
    for (const Index piece : members[own])
      if (facet[piece] == own) {
        open.push_back(piece);
        held += pieces.moments(piece);
      }
    if (held.area < least_left * area[own] || !(held.area > 0)) {
      for (const Index piece : open) facet[piece] = -1;
      continue;
    }
    FacetPlane plane = plane_of(held);
    double fitted = held.area;
    constexpr std::size_t stretch = 4096;  // pieces between questions whether to go on
    for (std::size_t k = 0; k < open.size(); ++k) {
      if (k % stretch == 0) context.check();
      pieces.for_each_next(open[k], [&](Index next) {
        if (facet[next] == own || (facet[next] >= 0 && rank[facet[next]] < rank[own]) ||
            !pieces.is_in(plane, next))
          return;
        facet[next] = own;
        open.push_back(next);
        held += pieces.moments(next);
        if (held.area > refitted * fitted) {
          plane = plane_of(held);
          fitted = held.area;
        }
      });
    }
  }
  return facet;
}

/// The planar facets of a cloud's distinct points, by region growing: from where the surface is
/// flattest over neighbours near the plane whose normals agree. Great facets take points of lesser
/// ones that lie in their planes.
struct CloudFacets {
  CloudFacets(PointsView points, const Context& context);

  /// Squared, from x to the surface: the planes of facets with points about x, and tangent planes
  /// of points in none. Infinite where no point is near.
  double squared_distance(const Vector3& x) const;

  std::vector<std::int32_t> rows;  ///< of the distinct points in the cloud
  SurfacePoints surface;           ///< these
  std::vector<Index> facet;        ///< of each of them, -1: none
  std::vector<FacetPlane> planes;  ///< of the facets
  double noise = 0;                ///< standard deviation of the points
};

struct CloudFacets;

/// A stretch of sharp edges from one corner to the next, or around to its beginning.
struct FeatureLine {
  static constexpr int steps = 8;

  Index start = -1, end = -1;  ///< corners; -1 both: closed, and smooth all around
  double length = 0;
  std::array<Vector3, steps> samples;  ///< at equal steps along it, beginning with the start
  /// Unit vectors across the line into the facets at its middle: they say how the surface bends.
  std::vector<Vector3> wings;
  double wing_error = 0;      ///< radians that noise may have turned them by
  std::vector<Index> points;  ///< of the mesh, or of the cloud the nearest to samples

  bool has_ends() const { return start >= 0; }
  const Vector3& middle() const { return samples[steps / 2]; }
};

/// The feature lines of a shape with the graph that they are the edges of.
struct FeatureLines {
  std::vector<FeatureLine> lines;
  std::vector<Vector3> corners;
  std::vector<std::vector<Index>> at;  ///< the lines at each corner, ascending; both ends may be
  double noise = 0;                    ///< standard deviation of the points
};

/// The lines along which nearly flat facets meet at more than `angle` radians, or end (Bokeloh et
/// al. 2009). They meet in corners, where one bends by more than that, or where another number of
/// edges than two come together. Points at the same place are one.
FeatureLines feature_lines(PointsView points, TrianglesView faces, double angle,
                           const Context& context);

/// Of a cloud: where its planar facets cross, up to the corners of three.
FeatureLines feature_lines(const CloudFacets& cloud, double angle, const Context& context);

/// Edges from one corner to the next, or around to their beginning, with the nodes between them.
struct LineChain {
  std::vector<Index> nodes, edges;
};

/// All edges in chains. `ends`: the nodes of each edge, -1 both where it is none. `at`: the edges
/// at each node, two where it is no corner. `corner`: of each node its number, -1: none.
std::vector<LineChain> line_chains(const std::vector<std::array<Index, 2>>& ends,
                                   const std::vector<std::vector<Index>>& at,
                                   const std::vector<Index>& corner);

/// Sets a line's length, and its samples along the nodes. Returns the number of the node at the end
/// of the edge with the line's middle.
std::size_t sample_along(const std::vector<Vector3>& nodes, FeatureLine& line);

/// Of each corner the lines at it.
void connect(FeatureLines& graph);

/// A motion or reflection and the connected feature lines that it takes to feature lines.
struct LineMatch {
  Eigen::Isometry3d map = Eigen::Isometry3d::Identity();
  std::vector<std::pair<Index, Index>> lines;  ///< a line and its image, in the order they join

  /// A motion comes before a reflection, what turns less before what turns more.
  double plainness() const;
};

/// Grows matches along the graph of feature lines. A line is taken to another where their lengths,
/// courses, ends and the faces beside them agree: both ends hold it, so that it cannot slide. In a
/// tangle of lines, which takes very many comparisons, matches stop growing.
class LineMatching {
 public:
  /// `taken`: lines that take no part. `tolerance`: how far images may be off, input units.
  LineMatching(const FeatureLines& graph, double tolerance, const std::vector<char>& taken)
      : graph_(graph), tolerance_(tolerance), taken_(taken) {}

  /// Which end of the line is taken to which of the other's, and whether by a reflection.
  struct Pose {
    bool reversed, reflected;
  };
  static constexpr Pose poses[] = {{false, false}, {false, true}, {true, false}, {true, true}};

  /// What begins with a line that has two ends; nothing where that does not match.
  std::optional<LineMatch> grown(Index line, Index image, Pose pose);

  /// Whether a map takes a line to another.
  bool agrees(const Eigen::Isometry3d& map, const FeatureLine& line, const FeatureLine& image,
              bool reversed) const;

 private:
  std::vector<std::pair<Index, Index>> reached(const Eigen::Isometry3d& map, Index line,
                                               Index image, bool reversed);
  Eigen::Isometry3d fitted(const LineMatch& match) const;

  const FeatureLines& graph_;
  double tolerance_;
  const std::vector<char>& taken_;
  std::size_t compared_ = 0;
};

/// Feature lines by local numbers: see ConnectedLines.
using LocalLines = std::vector<std::int32_t>;

/// A map with where it takes the lines that are connected with the seed.
struct LocalMatch {
  Eigen::Isometry3d map;
  std::vector<std::int32_t> images;  ///< the line that each local one is taken to; -1: none
  double length = 0;                 ///< of the lines that have an image
};

/// The feature lines that are connected with a seed. They have local numbers: 0 is the seed, then
/// come the others in the order in which they are reached.
class ConnectedLines {
 public:
  /// `own`: the match of the seed with itself.
  ConnectedLines(const FeatureLines& graph, const LineMatch& own);

  std::size_t size() const { return lines_.size(); }
  /// The number in the graph of a local line.
  Index number(std::size_t local) const { return lines_[local]; }
  const FeatureLine& line(std::size_t local) const { return graph_.lines[lines_[local]]; }
  Vector3 middle(std::size_t local) const { return line(local).middle(); }
  const FeatureLines& graph() const { return graph_; }

  LocalMatch local(const LineMatch& match) const;

  /// First one map, then the other.
  LocalMatch after(const LocalMatch& second, const LocalMatch& first) const;

  /// The lines connected with the seed by lines that have an image by this share of the maps.
  LocalLines common(const std::vector<const LocalMatch*>& matches, double share) const;

  /// Lines connected with `start`, first those nearer to a point, that have an image by this share
  /// of the maps; no line is an image twice.
  LocalLines disjoint(const std::vector<const LocalMatch*>& matches, std::int32_t start,
                      const Vector3& point, double share) const;

 private:
  template <typename Visit>
  void for_each_next(std::int32_t line, const Visit& visit) const;

  const FeatureLines& graph_;
  std::vector<Index> lines_;         // of each local number
  std::vector<std::int32_t> local_;  // of each line; -1: not connected with the seed
};

/// Radians: turns that differ by less are one.
inline constexpr double same_turn = 0.02;

/// A sector of a ring: lines that a turn by an n-th of a circle takes around an axis, as that of a
/// gear takes a tooth.
struct RingSector {
  LocalLines lines;               ///< of one sector; none: there is no ring
  std::vector<LocalMatch> turns;  ///< the powers of the turn, the identity first
};

/// The sector of the least such turn, by a third of a circle or less, among the matches. The first
/// of these is the identity.
RingSector ring_sector(const ConnectedLines& around, const std::vector<LocalMatch>& matches);

/// Lines that recur, and the maps to their instances.
struct RecurringPart {
  std::vector<Index> lines;  ///< of the first instance
  struct Instance {
    Eigen::Isometry3d map = Eigen::Isometry3d::Identity();  ///< from the first
    std::vector<Index> lines;                               ///< the images, in the order of lines
  };
  std::vector<Instance> instances;  ///< the first by the identity
  double length = 0;                ///< of the lines of one
  bool is_whole = false;            ///< no other line goes on from it

  /// Instances that have all lines.
  std::size_t complete_instances() const;

  /// What a description by one instance and maps to the others saves.
  double saved() const { return length * static_cast<double>(instances.size() - 1); }
};

/// Of the length of a part: what an instance has of it at least where there is noise, and of the
/// matches, those that have an image of a line of the part.
inline constexpr double least_share = 0.6;

/// Of those that save nearly as much as any a whole before a piece, then that with the most
/// instances; the end for none.
std::vector<RecurringPart>::iterator best_part(std::vector<RecurringPart>& parts);

/// The best part with this line; without instances where there is none. `alike`: the
/// lines that it may be taken to, itself among them. No line is in two instances.
RecurringPart seed_part(Index seed, const std::vector<Index>& alike, const FeatureLines& graph,
                        LineMatching& matching, const Context& context);

/// Parts of closed lines without corners, as the rims of holes are: circles of one size, and other
/// curves by their principal axes.
std::vector<RecurringPart> closed_line_parts(const FeatureLines& graph, double tolerance,
                                             const Context& context);

/// Joins parts whose instances lie to each other the same way, as a frame and its panes do.
std::vector<RecurringPart> united(std::vector<RecurringPart> parts, const FeatureLines& graph,
                                  double tolerance);

/// The recurring parts of a graph of feature lines (Bokeloh et al. 2009), those that save most
/// first, at most `count`. No line is in two instances.
std::vector<RecurringPart> part_search(const FeatureLines& graph, double tolerance, Index count,
                                       const Context& context);

/// From a position to the surface, infinite far from it.
using SquaredDistance = std::function<double(const Vector3& x)>;

/// Which instance each point of a mesh belongs to, and how well instances fit.
struct PartPoints {
  /// Of each point; -1: none.
  std::vector<Index> part, instance;
  /// Of each instance of each part: 1 where the surface about the lines of the first lands on the
  /// surface, less the farther off it comes, 0 beyond the tolerance.
  std::vector<std::vector<double>> scores;
  /// The points of each instance of each part, ascending. A corner may be one of two instances: it
  /// is among those of both, though it counts for the first.
  std::vector<std::vector<std::vector<Index>>> members;
};

/// A point belongs to the instance with the feature line nearest to it, where it lies in the box
/// around that one's lines.
PartPoints part_points(PointsView points, const FeatureLines& graph,
                       const std::vector<RecurringPart>& parts, double tolerance,
                       const SquaredDistance& to_surface, const Context& context);

}  // namespace symsurf
