#pragma once

#include <symsurf/context.h>
#include <symsurf/method.h>
#include <symsurf/result.h>

#include <optional>
#include <vector>

namespace symsurf {

/// The skin of bodies that a cloud fills: the points that have others on one side only. It alone
/// tells of a mirror, as the image of what is inside mostly comes to lie inside, whatever mirrors.
class Skin {
 public:
  /// Of a cloud that fills bodies. The cloud and the values of the method's parameters must outlive
  /// the skin.
  Skin(const Cloud& cloud, const ParameterValues& values, const Context& context);
  /// None where it fills none, the method sees the inside or needs more points than the skin has.
  static std::optional<Skin> where_filled(const Cloud& cloud, const Method& method,
                                          const ParameterValues& values, const Context& context);

  Index size() const { return static_cast<Index>(points_.size()); }

  /// Of these rows, one a point of the cloud, those of the skin.
  Points rows(PointsView all) const;

  /// From what was found of the skin to what it says of all points: partners are looked for among
  /// all.
  void hand_on(Result& result) const;

 private:
  const Cloud& cloud_;
  const ParameterValues& values_;
  Context context_;
  std::vector<Index> points_;
};

}  // namespace symsurf
