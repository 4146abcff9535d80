#pragma once

#include <symsurf/context.h>
#include <symsurf/method.h>
#include <symsurf/result.h>

#include <optional>

#include "preprocess/row_removal.h"

namespace symsurf {

/// The few points of a cloud that lie far off the rest: what a scanner saw in the air, pixels
/// without depth that were written as the origin. They would set the scale of everything else. Of
/// all processes, where several share the cloud out.
class Strays {
 public:
  /// None where there are none, or fewer points than needed would be left. Collective.
  static std::optional<Strays> where_any(const Cloud& cloud, Index needed, const Context& context);
  /// Nor where the method sees strays.
  static std::optional<Strays> where_any(const Cloud& cloud, const Method& method,
                                         const Context& context);

  /// Of these rows, one a point of this process, those of no strays.
  Points rows(PointsView all) const { return removal_.apply(all); }
  /// The faces between no strays, by their new numbers. `points`: how many there were.
  Triangles faces(TrianglesView all, Index points) const { return removal_.apply(all, points); }

  /// From what was found of the rest to what it says of all points: strays have no partners.
  void hand_on(Result& result) const;

 private:
  Strays(const Cloud& cloud, Index needed, const Context& context);

  RowRemoval removal_;
};

}  // namespace symsurf
