#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "recurring/feature_lines.h"

namespace symsurf {

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

}  // namespace symsurf
