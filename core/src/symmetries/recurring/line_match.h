#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <utility>
#include <vector>

#include "symmetries/recurring/feature_lines.h"

namespace symsurf {

/// A motion or reflection and the connected feature lines that it takes to feature lines.
struct LineMatch {
  Eigen::Isometry3d map = Eigen::Isometry3d::Identity();
  std::vector<std::pair<Index, Index>> lines;  ///< a line and its image, in the order they join

  /// A motion comes before a reflection, what turns less before what turns more.
  double plainness() const;
};

/// Grows matches along the graph of feature lines. A line is taken to another where their lengths,
/// courses, ends and the faces beside them agree: both ends hold it, so that it cannot slide.
class LineMatching {
 public:
  /// `taken`: lines that take no part. `tolerance`: how far images may be off, input units.
  LineMatching(const FeatureLines& graph, double tolerance, const std::vector<char>& taken)
      : graph_(graph), tolerance_(tolerance), taken_(taken) {}

  /// Which end of the line is taken to which of the other's, and whether by a reflection.
  struct Pose {
    bool reversed, reflected;
  };

  /// What begins with a line that has two ends; nothing where that does not match.
  std::optional<LineMatch> grown(Index line, Index image, Pose pose) const;

  /// Whether a map takes a line to another.
  bool agrees(const Eigen::Isometry3d& map, const FeatureLine& line, const FeatureLine& image,
              bool reversed) const;

 private:
  std::vector<std::pair<Index, Index>> reached(const Eigen::Isometry3d& map, Index line,
                                               Index image, bool reversed) const;
  Eigen::Isometry3d fitted(const LineMatch& match) const;

  const FeatureLines& graph_;
  double tolerance_;
  const std::vector<char>& taken_;
};

}  // namespace symsurf
