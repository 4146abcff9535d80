#pragma once

// Finding the mirror of a shape, and how well a known one fits it.

#include <symsurf/context.h>
#include <symsurf/mirror.h>
#include <symsurf/parameter.h>
#include <symsurf/points.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace symsurf {

/// The one description of a method. Front ends are made by looping over methods().
struct Method {
  std::string name;
  std::string title;    ///< for menus: "Mirror plane"
  std::string summary;  ///< one sentence
  std::vector<Parameter> parameters;
  Index minimum_points = 4;
  bool automatic = false;  ///< one of those that "auto" tries
};

/// Of the parameter "tolerance" of all methods, in diagonals: the sides of scanned faces and skulls
/// differ by less.
inline constexpr double usual_tolerance = 0.004;

/// All methods, in the order front ends show them.
const std::vector<Method>& methods();

/// Throws InvalidParameter, listing the names there are.
const Method& method(std::string_view name);

/// What a method found. No symmetry is a result too: one with a low score.
struct Result {
  std::string method;
  std::shared_ptr<Mirror> mirror;  ///< null: none found, or surface points only
  /// Midpoints of the pairs, at most half a residual off the mirror; perpendicular, quadric and
  /// fixed_direction project them onto it. Input units.
  Points surface_points;
  Pairs pairs;                ///< (point, partner), indices into the input
  Eigen::VectorXd residuals;  ///< distance from the image to the partner, input units
  /// 0: no symmetry; 1: as good as the sampling shows. The share of the shape that the mirror maps
  /// onto its surface, over the share that passes the same test without a mirror. The rest has no
  /// counterpart, "missing_share" of the statistics, or differs from it, "contradicted_share". Of
  /// height fields and free forms it is multiplied by the probability that chance did not make
  /// them.
  double score = 0;
  /// Other mirrors, without pairs, by score; none scores more than the result.
  std::vector<Result> candidates;
  Values parameters;  ///< as used
  /// "verdict", "found" or "none"; "reason", a sentence that says why; "mapped_share",
  /// "missing_share" and "contradicted_share" of the points that the mirror moves, 0 to 1, which
  /// sum to 1; "exact_share": those whose image is a point of the shape; "deviation": the median
  /// distance of mapped images from the shape's surface, input units; "evidence", 0 to 1: whether
  /// the mirror maps the shape better than the same mirror turned and shifted;
  /// "deciding_share", the share of the points that tell it from those; of any shape
  /// "log_odds" that chance did not make it, in nats, by the smoothness of its middle; "angle_sd"
  /// and "offset_sd": standard deviations of the mirror's orientation about its middle, degrees,
  /// and along its normal, input units; "explained_share" and "covered_share", older names of the
  /// mapped share and of what is not missing; whatever else the method reports; and, where there
  /// are some, how many "nonfinite_points" were left out as not finite and how many "outliers" as
  /// lying far off: they have no partners. "surface_samples": how many points were sampled on the
  /// faces. "boundary_points" of a volumetric cloud, where the mirror and the score are those of
  /// its boundary: how many it has. "warning": a sentence for the caller, where the method is not
  /// for such a cloud.
  Values statistics;
  double seconds = 0;

  /// "found" where there is a mirror whose score is at least `minimum_score`, else "none".
  const std::string& verdict() const { return std::get<std::string>(statistics.at("verdict")); }
  /// Why, in a sentence.
  const std::string& reason() const { return std::get<std::string>(statistics.at("reason")); }
};

/// The numbers of a result's candidates, one row a candidate, best first: "candidate_scores" (n, 1)
/// and, where all are planes, "candidate_normals" (n, 3) and "candidate_offsets" (n, 1). None where
/// there are no candidates.
Values candidate_values(const Result& result);

/// The mirror that a detection gives to what needs one.
struct FoundMirror {
  std::shared_ptr<Mirror> mirror;
  std::string warning;  ///< for the caller, where the verdict is "none"; else empty
};

/// The mirror of a result, whatever its verdict. Throws InvalidInput where there is none, and, with
/// `require_found`, with the reason where the verdict is "none".
FoundMirror found_mirror(const Result& result, bool require_found = false);

/// The description of `require_found`, for what finds a mirror first.
const Parameter& require_found_parameter();

struct Options {
  std::string method = "auto";
  Values parameters = {};   ///< the method's, by name; the rest keep their defaults
  PointsView normals = {};  ///< optional, one a point; taken as lines, their sign does not count
  std::uint64_t seed = 0;   ///< of the methods that draw at random
  /// Optional triangles between the points, which are then the vertices of a mesh: samples spread
  /// evenly over its surface find the mirror; score and candidates are those of the samples, pairs
  /// those of the vertices. There are none where a thousand or more vertices lie evenly. A mirror
  /// that maps vertices onto vertices, and the surface with them, scores 1. A face without an area
  /// is passed over. The thesis's methods, and processes that share out the points, see the points
  /// only.
  TrianglesView faces = {};
  /// Whether a point with a NaN or infinite coordinate is an error. Otherwise such points are left
  /// out, with their faces, and have no partners: Result::statistics has their number.
  bool refuse_nonfinite = false;
};

/// Finds the mirror of a point set. The points are read in place and must stay alive for the call.
/// Where the context has several processes, the points (maybe none) and normals are this process's,
/// all of them call this alike, and the mirror is that of the whole. Pairs are those of the own
/// points, numbered through all processes in the order of their ranks. The mirror is found by rank
/// 0, the root, alone, so it is the one to cancel: of all points, or, of more than 262,144 without
/// normals, of their PointSummary, so that a process needs memory for its own points only. The
/// methods of the thesis and the baselines get all. Throws InvalidInput (too few finite points,
/// more than 2^30 in one process, all points equal or on one line, an extent beyond 1e-50 to 1e50,
/// a coordinate beyond 1e50, normals that are not one a point, not finite or zero, a face that
/// names a point which is not there), InvalidParameter (unknown method or parameter, value out of
/// range) and Cancelled.
Result detect(PointsView points, const Options& options = {}, const Context& context = {});

/// The length of which `detect`, run alike, takes parameters of the unit "diagonal" as fractions:
/// the diagonal of the axis-aligned bounding box of the points, without those that the method
/// leaves out as not finite or as outliers. `match` takes that of the method "auto". Of one
/// process's points; throws as detect does.
double diagonal(PointsView points, const Options& options = {}, const Context& context = {});

/// Pairs every point with the input point nearest to its image over a known mirror, where that is
/// nearer than `pair_distance` times the diagonal: how a mirror found elsewhere, or one of
/// Result::candidates, fits. Equally near partners: the lowest index. Points far off the rest have
/// no partners, as in detect, and do not count for the diagonal; nor do points that are not finite,
/// which `refuse_nonfinite` makes an error. The score and the verdict are those that detect gives.
/// `tolerance`: of diagonals, as the parameter of that name of every method. `faces`: as in
/// Options. Throws InvalidInput and Cancelled as detect does, InvalidParameter for a negative
/// distance and a tolerance beyond [1e-4, 0.1].
Result match(PointsView points, const Mirror& mirror, double pair_distance = 0.05,
             const Context& context = {}, bool refuse_nonfinite = false,
             double tolerance = usual_tolerance, TrianglesView faces = {});

/// The mirror that points lie on: of a mid-surface that was drawn or known, of the midpoints of
/// pairs, or of a method that ends with points. `kind`: "plane", "sphere", "cylinder", "quadric" or
/// "free-form"; "auto" takes the likeliest, each number more of which has to pay (Schwarz 1978).
/// Residuals are taken as Student's of 3 degrees: a third of the points may lie elsewhere. With a
/// direction of mapping a plane becomes an oblique one, and a free form, which has to be a graph
/// along it, a height field. The points are the mirror's footprint. Throws InvalidInput for fewer
/// points than the kind has numbers, for points that are not finite or lie on one line, and where
/// they determine no mirror of the kind, or none along the direction; InvalidParameter for an
/// unknown kind; Cancelled.
std::shared_ptr<Mirror> fit_mirror(PointsView points, std::string_view kind = "auto",
                                   const std::optional<Vector3>& direction = std::nullopt,
                                   const Context& context = {});

}  // namespace symsurf
