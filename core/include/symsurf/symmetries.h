#pragma once

#include <symsurf/context.h>
#include <symsurf/plane.h>
#include <symsurf/points_view.h>
#include <symsurf/symmetry_axis.h>
#include <symsurf/triangles_view.h>

#include <string>
#include <vector>

namespace symsurf {

/// The point group of a shape: every rigid motion and reflection that maps it onto itself.
struct Symmetries {
  /// In Schoenflies' notation: "C1", "Cs", "Ci", "C4", "C4v", "C4h", "D4", "D4h", "D4d", "S8", "T",
  /// "Td", "Th", "O", "Oh", "I", "Ih", "C∞", "C∞h", "C∞v", "D∞", "D∞h" or "K", in UTF-8.
  std::string group = "C1";
  Vector3 centre = Vector3::Zero();  ///< which all elements keep in its place, input units
  /// All mirror planes; of a continuous group those that are no turned copies of others: one that
  /// holds the axis, one across it; of K none.
  std::vector<Plane> planes;
  /// All rotation axes, highest order first, continuous ones before; of D∞h beside the continuous
  /// one a single axis of order 2; of K three at right angles.
  std::vector<SymmetryAxis> axes;
  bool inversion = false;  ///< x -> 2 centre - x maps the shape onto itself
  /// Every element on homogeneous columns (x, y, z, 1), the identity first; of a continuous group
  /// those that, with the turns about the continuous axes, make up all.
  std::vector<Matrix4> elements;
  /// Of each element how far it takes the shape off itself, input units: the greatest distance from
  /// the image of a vertex to the surface, of a cloud from that of a point to the nearest point. Of
  /// large shapes by a sample of their points.
  std::vector<double> max_deviations;
  double score = 1;    ///< how well images lie on the shape where it has points, 0 to 1
  double missing = 0;  ///< share of the images that fall where it has none: what is cut away
  double seconds = 0;  ///< that it took
};

struct SymmetryOptions {
  TrianglesView faces = {};       ///< optional, between the points, as detect() takes them
  bool refuse_nonfinite = false;  ///< whether a point that is not finite is an error
  double minimum_score = 0.7;     ///< of a group, [0, 1]
  double tolerance = 0;           ///< of Symmetries::max_deviations, input units; 0: any
};

/// Finds the point group of a shape. Of at most 1000 points without faces, as landmarks and the
/// atoms of a molecule are, it is that of all isometries that map each point onto one of them, to
/// the rounding of single precision, where there are any but the identity. Otherwise a group counts
/// where its elements map the shape onto itself wherever it has points, where hardly any point is
/// confirmed by too few of its images, as a bottle's handle is when the bottle is turned, and where
/// at most a third of the images fall where the shape has none. Orders are products of primes up to
/// 31 and their powers up to 64, 128 at most. Groups of turns about several axes without any mirror
/// (T, O, I) are found only where the principal axes are among theirs. Throws InvalidInput and
/// Cancelled as detect() does, InvalidParameter for minimum_score and tolerance.
Symmetries find_symmetries(PointsView points, const SymmetryOptions& options = {},
                           const Context& context = {});

}  // namespace symsurf
