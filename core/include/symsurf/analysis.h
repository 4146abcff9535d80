#pragma once

#include <symsurf/context.h>
#include <symsurf/operation.h>
#include <symsurf/parameter.h>
#include <symsurf/plane.h>
#include <symsurf/points_view.h>
#include <symsurf/symmetry_axis.h>
#include <symsurf/triangles_view.h>
#include <symsurf/value.h>

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace symsurf {

/// The one description of a search for symmetries other than a single mirror. Front ends are made
/// by looping over analyses().
struct Analysis {
  std::string name;
  std::string title;    ///< for menus: "Partial symmetries"
  std::string summary;  ///< one sentence
  std::vector<Parameter> parameters;
  std::vector<PointArray> arrays;
  std::string shown;  ///< the array to colour points by; empty: none
  Index minimum_points = 4;
  bool needs_faces = false;       ///< a bare cloud is InvalidInput
  bool finds_elements = false;    ///< AnalysisResult::planes and axes
  bool finds_transforms = false;  ///< AnalysisResult::transformations
};

/// All analyses, in the order front ends show them.
const std::vector<Analysis>& analyses();

/// Throws InvalidParameter, listing the names there are.
const Analysis& analysis(std::string_view name);

/// A motion, reflection or similarity that maps the shape, or a part of it, onto another part.
struct Transformation {
  /// "identity", "rotation", "translation", "screw", "reflection", "glide reflection",
  /// "inversion", "rotary reflection" or "similarity".
  std::string kind;
  Matrix4 matrix;    ///< on homogeneous columns (x, y, z, 1), input units
  double score = 0;  ///< how well what is mapped fits, 0 to 1
  /// The points of the input that are mapped, and those they fall on, ascending; both empty: all.
  std::vector<Index> from, onto;

  /// Where to draw it: the image of the centroid of the points that are mapped.
  Vector3 place(PointsView points) const;
};

struct AnalysisOptions {
  Values parameters = {};    ///< by name; the rest keep their defaults
  TrianglesView faces = {};  ///< optional, between the points
  /// Whether a point that is not finite is an error. Otherwise such points are left out, with their
  /// faces: AnalysisResult::statistics has their number.
  bool refuse_nonfinite = false;
};

struct AnalysisResult {
  std::string analysis;
  /// Analysis::arrays: one row a point of the input; of points left out NaN, -1 or 0, by type.
  std::map<std::string, Eigen::MatrixXd> arrays;
  std::vector<Plane> planes;  ///< each with the footprint
  std::vector<SymmetryAxis> axes;
  std::vector<Transformation> transformations;
  /// Points that stand for the shape: what planes and axes are drawn over.
  std::shared_ptr<const Points> footprint;
  Values parameters;  ///< as used
  Values statistics;
  double seconds = 0;
};

/// Runs an analysis. The points are read in place and must stay alive for the call. No symmetry is
/// a result too. Throws InvalidInput as detect() does, or for a cloud where faces are needed;
/// InvalidParameter for an unknown name, parameter or value; Cancelled.
AnalysisResult analyse(std::string_view name, PointsView points,
                       const AnalysisOptions& options = {}, const Context& context = {});

}  // namespace symsurf
