#pragma once

#include <functional>
#include <vector>

#include "recurring/connected_lines.h"

namespace symsurf {

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
