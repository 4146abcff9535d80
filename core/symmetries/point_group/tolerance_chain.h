#pragma once

#include <symsurf/context.h>

#include <functional>
#include <optional>
#include <vector>

#include "point_group/point_group.h"
#include "point_group/surface_distance.h"
#include "point_group/symmetry_search.h"

namespace symsurf {

/// A point group in a pose of SurfaceDistance::frame(), and how far its elements take the surface
/// off itself.
struct MeasuredGroup {
  PointGroup group;
  GroupPose pose;
  ImageDeviation deviation;                            ///< of all elements
  std::vector<ImageDeviation> each{ImageDeviation()};  ///< of each of tested_elements()

  bool is_continuous() const { return group.continuous || group.all; }
  /// Number of elements; of continuous groups some thousands for each.
  double size() const;
};

/// Whether a group lies in another, as both stand: by the elements nearest to each other.
bool is_within(const MeasuredGroup& one, const MeasuredGroup& other);

/// Sets the deviations; looks at some 60,000 images.
void measure(MeasuredGroup& own, const SurfaceDistance& surface, const Context& context);

/// The groups whose elements, all fitted in one pose, map a surface onto itself to within some
/// tolerance.
///
/// Turns and mirrors about 600 directions through the centroid are tried on a grid of distances.
/// From the minima come axes, from these the groups about them, up to turns by 1/64. Poses are
/// fitted to the distances of all images at once.
class TolerancedGroups {
 public:
  TolerancedGroups(const SurfaceDistance& surface, const Context& context);

  /// Another one, measured.
  void add(const MeasuredGroup& own) { found_.push_back({own, true}); }

  using Accepts = std::function<bool(const MeasuredGroup&)>;
  /// The largest that is accepted, all of whose elements were measured; C1 where none is.
  MeasuredGroup largest(const Accepts& accepts, bool by_quantile);

  /// Of groups each of which contains the one before, from C1 on, through a given one, those that
  /// have the most elements over all tolerances. `by_quantile`: ordered by the quantile of the
  /// deviation, otherwise by its maximum.
  std::vector<MeasuredGroup> chain(const MeasuredGroup& through, bool by_quantile);

 private:
  struct Held : MeasuredGroup {
    bool is_measured = false;  // in full
  };
  struct Fitting {
    int steps;
    bool is_rough, to_maximum;
  };
  GroupPose fitted(GroupPose pose, const std::vector<Matrix3>& elements,
                   const Fitting& fitting) const;
  double rough_mean(const GroupPose& pose, const std::vector<Matrix3>& elements) const;
  bool is_dominated(const ImageDeviation& deviation, double size) const;
  std::optional<MeasuredGroup> tried(const PointGroup& group, const GroupPose& start);
  void measure_in_full(Held& held, bool by_quantile) const;

  void search();
  std::vector<GroupPose> lines();
  void add_polyhedral();
  void add_about(Index order, const GroupPose& axis);
  void add_turns(const std::vector<GroupPose>& axes);

  const SurfaceDistance& surface_;
  const Context context_;
  std::vector<Held> found_;
};

}  // namespace symsurf
