#pragma once

#include <symsurf/mirror.h>
#include <symsurf/triangles_view.h>

namespace symsurf {

/// What a mesh has on the two sides of a mirror, square and cubic input units. Faces that the
/// mirror cuts count in part.
struct Sides {
  double positive_area = 0, negative_area = 0;
  double positive_volume = 0, negative_volume = 0;  ///< of a watertight mesh, else meaningless

  /// (positive - negative) / (positive + negative), -1 to 1; 0: symmetric.
  static double index(double positive, double negative);
};

/// The volume between the faces of a side and their feet on the mirror. For a mirror that bends,
/// the feet of a face are taken for a triangle. Where points have no foot, NaN.
Sides measured_sides(PointsView points, TrianglesView faces, const Mirror& mirror,
                     const Context& context);

}  // namespace symsurf
