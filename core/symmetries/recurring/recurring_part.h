#pragma once

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

}  // namespace symsurf
