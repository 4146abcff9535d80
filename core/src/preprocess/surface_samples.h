#pragma once

#include <symsurf/context.h>
#include <symsurf/method.h>
#include <symsurf/result.h>
#include <symsurf/triangles_view.h>

#include <optional>

namespace symsurf {

/// Throws InvalidInput naming the first face with a corner that is none of so many points.
void require_corners(TrianglesView faces, Index points);

/// The area of the faces, in square input units.
double surface_area(PointsView points, TrianglesView faces);

/// Pre-processing that samples a triangle mesh evenly: its vertices, and a lattice of points on
/// every face that is larger than the lattice's spacing. Mirrored faces get mirrored samples; two
/// faces that make up a rectangle get the same grid whichever diagonal divides it.
class SurfaceSamples {
 public:
  /// None where all faces are smaller, or many vertices lie evenly as they are. The cloud's points
  /// are the vertices, used by a face or not; the cloud and the values of the method's parameters
  /// must outlive the samples.
  static std::optional<SurfaceSamples> where_coarse(const Cloud& cloud, TrianglesView faces,
                                                    const ParameterValues& values,
                                                    const Context& context);

  /// The vertices, then the samples.
  const Points& points() const { return points_; }
  /// The vertices' normals, then those of the samples' faces; no rows where the cloud has none.
  const Points& normals() const { return normals_; }

  /// From what was found of the samples to what it says of the vertices: their partners are looked
  /// for among them.
  void map_back(Result& result) const;

 private:
  SurfaceSamples(const Cloud& cloud, const ParameterValues& values, const Context& context)
      : cloud_(cloud), values_(values), context_(context) {}

  const Cloud& cloud_;
  const ParameterValues& values_;
  Context context_;
  Points points_, normals_;
};

}  // namespace symsurf
