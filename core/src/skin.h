#pragma once

#include <symsurf/context.h>
#include <symsurf/method.h>
#include <symsurf/result.h>

#include <optional>
#include <vector>

namespace symsurf {

/// Do the points fill bodies, as the voxels of a mask do, in place of lying on surfaces? Collective
/// where several processes share them out: the same answer as one gets of all.
bool fills_bodies(const Cloud& cloud, const Context& context);

/// The skin of bodies that a cloud fills: the points that have others on one side only. It alone
/// tells of a mirror, as the image of what is inside mostly comes to lie inside, whatever mirrors.
class Skin {
 public:
  /// None where the cloud fills no bodies, or its skin has fewer points than needed. The cloud and
  /// the values of the method's parameters must outlive it.
  static std::optional<Skin> where_filled(const Cloud& cloud, Index needed,
                                          const ParameterValues& values, const Context& context);
  /// Nor where the method sees the inside.
  static std::optional<Skin> where_filled(const Cloud& cloud, const Method& method,
                                          const ParameterValues& values, const Context& context);

  /// Of these rows, one a point of the cloud, those of the skin.
  Points rows(PointsView all) const;

  /// From what was found of the skin to what it says of all points: partners are looked for among
  /// all.
  void hand_on(Result& result) const;

 private:
  Skin(const Cloud& cloud, const ParameterValues& values, const Context& context);

  const Cloud& cloud_;
  const ParameterValues& values_;
  Context context_;
  std::vector<Index> points_;
};

}  // namespace symsurf
