#pragma once

// What is done with a mirror.

#include <symsurf/context.h>
#include <symsurf/mirror.h>
#include <symsurf/parameter.h>
#include <symsurf/points.h>

#include <Eigen/Core>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace symsurf {

/// An array that an operation or an analysis gives each point.
struct PointArray {
  std::string name;
  ParameterType type = ParameterType::Real;  ///< or Integer or Boolean
  int components = 1;
  std::string doc;            ///< one sentence, with the unit
  bool is_signed = false;     ///< 0 belongs in the middle of a colour map
  bool names_points = false;  ///< the values are indices of points, -1 for none
  bool names_faces = false;   ///< likewise of faces
  bool names_other = false;   ///< likewise of points of the other of two shapes
};

/// The one description of what is done with a mirror. Front ends are made by looping over
/// operations().
struct Operation {
  std::string name;
  std::string title;    ///< for menus: "Mirror asymmetry"
  std::string summary;  ///< one sentence
  std::vector<Parameter> parameters;
  std::vector<PointArray> arrays;
  std::vector<PointArray> face_arrays;  ///< likewise, one value a face
  std::string shown;                    ///< the array to colour points by; none: the colours stay
  bool moves_points = false;            ///< the result's points are not those of the input
  bool adds_points = false;             ///< behind those of the input, and faces behind its faces
  bool makes_shape = false;             ///< may give OperationResult::point_parents
  bool takes_mask = false;              ///< OperationInput::mask
  bool needs_faces = false;             ///< bare clouds are refused
  /// Points and faces stay, what the input has at its points moves: OperationResult::point_parents.
  bool carries_values = false;
  bool takes_other = false;       ///< OperationInput::other, in place of a mirror
  bool takes_any_mirror = false;  ///< not of the points alone: one of another thing, near or far
};

/// All operations, in the order front ends show them.
const std::vector<Operation>& operations();

/// Throws InvalidParameter, listing the names there are.
const Operation& operation(std::string_view name);

/// What an operation takes beside the mirror.
struct OperationInput {
  PointsView points;
  TrianglesView faces = {};   ///< none: a bare cloud
  Eigen::VectorXd mask = {};  ///< optional, one a point, in [0, 1]: how far it may move
  /// Optional, with homologous pairing: landmarks that mirror each other. A row per pair: x, y, z
  /// of both and the standard deviation of placing them, 0 or more; input units.
  Eigen::MatrixXd landmark_pairs = {};
  /// Optional, in place of a mirror: the second of two shapes of a pair, in a pose of its own, a
  /// mesh where the first is one. The operation is done to the first.
  PointsView other = {};
  TrianglesView other_faces = {};
  Index own_points = 0;  ///< where points from this one on are those of such a shape; 0: none is

  /// Those that the operation is done to.
  PointsView own() const { return own_points > 0 ? PointsView(points.data(), own_points) : points; }
};

struct OperationResult {
  std::string operation;
  Points points;    ///< those of the input, in their order, moved or not, then those added
  Triangles faces;  ///< those of the input, then those added
  /// Where something was added: of each point and face of the result, the one of the input that its
  /// attributes come from. Empty otherwise: each has its own.
  std::vector<Index> point_sources, face_sources;
  /// Of a shape of other points and faces altogether, and where values are carried: of each point
  /// the points of the input that its values lie between, and their shares, which sum to 1. The
  /// one with most share is the point's source. No rows otherwise.
  Eigen::Matrix<Index, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> point_parents;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> point_shares;
  std::map<std::string, Eigen::MatrixXd> arrays;       ///< Operation::arrays: one row a point
  std::map<std::string, Eigen::MatrixXd> face_arrays;  ///< Operation::face_arrays: one row a face
  Values parameters;                                   ///< as used
  Values statistics;

  /// Whether points and faces are other ones than those of the input altogether.
  bool is_other_shape() const;
};

/// Runs an operation over a mirror of any kind, in the unit and pose of the points.
/// Points that are not finite are left out, with the faces that use them, and counted by the
/// statistic "nonfinite_points". Where the result has the points of the input they keep their
/// places, without values: NaN, -1 of an index, else 0.
/// Throws InvalidParameter for an unknown name, parameter or value; InvalidInput where no point is
/// finite or one has a coordinate beyond 1e50, a face names no point, the mask is not one value in
/// [0, 1] a point or the operation takes none, landmark pairs are not as said above, the mirror has
/// images for less than half of the points, or, but where it takes any, lies more than ten
/// diagonals away from them; a second shape is given to an operation that takes none, with a
/// mirror, or it is no mesh beside one, has points that are not finite or is what match_pair
/// refuses; Cancelled.
OperationResult operate(std::string_view name, const OperationInput& input, const Mirror& mirror,
                        const Values& parameters = {}, const Context& context = {});

/// Whether the operation takes a mirror, with these parameters: not about an axis. Throws
/// InvalidParameter.
bool needs_mirror(std::string_view name, const Values& parameters = {});

/// The same as above for a mirror that may be null where needs_mirror() says no: it is not looked
/// at then. Throws InvalidInput also where the axis lies more than ten diagonals away from the
/// points, or is not given and the shape has none.
OperationResult operate(std::string_view name, const OperationInput& input, const Mirror* mirror,
                        const Values& parameters = {}, const Context& context = {});

}  // namespace symsurf
