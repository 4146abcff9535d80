#pragma once

// Symmetries other than a single mirror.

#include <symsurf/context.h>
#include <symsurf/mirrors.h>
#include <symsurf/operations.h>
#include <symsurf/parameter.h>
#include <symsurf/points.h>

#include <array>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace symsurf {

/// A line about which a shape may be turned.
struct SymmetryAxis {
  Vector3 point;      ///< on the axis, input units: the centre of the group
  Vector3 direction;  ///< unit
  Index order = 0;    ///< a turn by 360 degrees / order maps the shape onto itself; 0: any turn

  /// Both ends of the piece to draw: along the points and a tenth of their extent beyond.
  /// Throws InvalidInput without points.
  std::array<Vector3, 2> segment(PointsView points) const;
};

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
  /// Of each element how far it takes the shape off itself, input units: the greatest distance of
  /// images from the surface, and the 95 % quantile over samples by area. Distances are those to
  /// triangles, of clouds to tangent planes, of at most 1000 points to the nearest point. Images
  /// beyond a rim are left out; those of large shapes are sampled.
  std::vector<double> max_deviations, quantile_deviations;
  /// The same of the turns about each continuous axis, in the order of axes: of eight.
  std::vector<double> axis_max_deviations, axis_quantile_deviations;
  /// The groups that hold within larger and larger tolerances, each of which contains the one
  /// before, from C1 to what an eighth of the diameter allows; this group is one of them.
  std::vector<Symmetries> by_tolerance;
  double max_deviation() const;       ///< the largest of all elements and turns
  double quantile_deviation() const;  ///< likewise
  double score = 1;    ///< how well images lie on the shape where it has points, 0 to 1
  double missing = 0;  ///< share of the images that fall where it has none: what is cut away
  double seconds = 0;  ///< that it took
};

struct SymmetryOptions {
  TrianglesView faces = {};       ///< optional, between the points, as detect() takes them
  bool refuse_nonfinite = false;  ///< whether a point that is not finite is an error
  double minimum_score = 0.7;     ///< of a group, [0, 1]
  double tolerance = 0;  ///< of Symmetries::max_deviations, input units; 0: by tolerance_rule
  /// What is the largest group: "given": max_deviations are within the tolerance; "rounding": they
  /// are within 0.1 % of the diameter or twice the sagitta of the tessellation, of open surfaces
  /// and clouds within what these show, unless a tolerance is given; "object": what pose benchmarks
  /// accept, quantile_deviations within 2.5 % of the diameter, of continuous groups 5 %; "bop":
  /// max_deviations within 15 units, millimetres there, or a tenth of the diameter.
  std::string tolerance_rule = "rounding";
  /// One row a point, a column a channel; empty: colours do not count. Else only what keeps them is
  /// a symmetry: nowhere may most of a dozen neighbours, of 20000 samples of the surface, fall
  /// where the colours differ by more than a tenth of their range, beyond what neighbours differ
  /// by.
  Eigen::MatrixXd colours = {};
};

/// Finds the point group of a shape. Of at most 1000 points without faces, as landmarks and the
/// atoms of a molecule are, it is that of all isometries that map each point onto one of them, to
/// the rounding of single precision, where there are any but the identity. Otherwise a group counts
/// where its elements map the shape onto itself wherever it has points, where hardly any point is
/// confirmed by too few of its images, as a bottle's handle is when the bottle is turned, and where
/// at most a third of the images fall where the shape has none. Orders are products of primes up to
/// 31 and their powers up to 64, 128 at most. Groups of turns about several axes without any mirror
/// (T, O, I) are found only where the principal axes are among theirs. Throws InvalidInput and
/// Cancelled as detect() does, InvalidInput for colours that are not one a point or not finite,
/// InvalidParameter for minimum_score and tolerance.
Symmetries find_symmetries(PointsView points, const SymmetryOptions& options = {},
                           const Context& context = {});

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
  bool takes_colours = false;     ///< AnalysisOptions::colours
  bool takes_other = false;       ///< AnalysisOptions::other, which it needs
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
  Eigen::MatrixXd colours = {};  ///< optional, one row a point, for the parameter "texture"
  PointsView other = {};         ///< a second shape, read in place too
  TrianglesView other_faces = {};
};

struct AnalysisResult {
  std::string analysis;
  /// Analysis::arrays: one row a point of the input; of points left out NaN, -1 or 0, by type.
  std::map<std::string, Eigen::MatrixXd> arrays;
  std::vector<Plane> planes;  ///< each with the footprint
  std::vector<SymmetryAxis> axes;
  std::vector<Transformation> transformations;
  std::vector<Symmetries> by_tolerance;  ///< Symmetries::by_tolerance, of "symmetries"
  /// Points that stand for the shape: what planes and axes are drawn over.
  std::shared_ptr<const Points> footprint;
  Values parameters;  ///< as used
  Values statistics;
  double seconds = 0;
};

/// Runs an analysis. The points are read in place and must stay alive for the call. No symmetry is
/// a result too. Throws InvalidInput as detect() does, and for colours that are not one a point or
/// not finite, or missing where texture is true; for another shape where none is taken, and for
/// none where one is; InvalidParameter for an unknown name, parameter or value; Cancelled.
AnalysisResult analyse(std::string_view name, PointsView points,
                       const AnalysisOptions& options = {}, const Context& context = {});

}  // namespace symsurf
