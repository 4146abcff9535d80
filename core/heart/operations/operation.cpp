#include "operations/operation.h"

#include <symsurf/context.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/named_values.h"
#include "cloud/cloud.h"
#include "cloud/triangle_mesh.h"
#include "operations/counterparts.h"

namespace symsurf {

namespace {

void require_mask(const Operation& operation, const Eigen::VectorXd& mask, Index points) {
  if (mask.size() == 0) return;
  if (!operation.takes_mask) throw InvalidInput(operation.name + " takes no mask");
  if (mask.size() != points)
    throw InvalidInput(std::to_string(mask.size()) + " mask values given for " +
                       std::to_string(points) + " points; one per point is needed");
  for (Index i = 0; i < mask.size(); ++i)
    if (!(mask[i] >= 0 && mask[i] <= 1))
      throw InvalidInput("mask value " + std::to_string(i) + " is " + to_string(Value(mask[i])) +
                         "; allowed is 0 to 1");
}

void require_pairs(const Operation& operation, const ParameterValues& values,
                   const Eigen::MatrixXd& pairs) {
  if (pairs.rows() == 0) return;
  const bool has_pairing =
      std::any_of(operation.parameters.begin(), operation.parameters.end(),
                  [](const Parameter& parameter) { return parameter.name == "pairing"; });
  if (!has_pairing || values.choice("pairing") != "homologous")
    throw InvalidInput("landmark pairs are given to " + operation.name +
                       "; they need the pairing homologous");
  if (pairs.cols() != 7 || !pairs.allFinite() || pairs.col(6).minCoeff() < 0)
    throw InvalidInput(
        "landmark pairs must be rows of 7 finite numbers, the last, their standard "
        "deviation, 0 or more");
}

// Whether the mirror is that of another unit or pose. Where one point is farther from it than this,
// none is near.
void require_near(PointsView points, const Mirror& mirror) {
  constexpr double farthest = 10;  // diagonals: a mirror between two objects is nearer
  const double distance = std::abs(mirror.signed_distance(points[0]));
  const double diagonal = diagonal_of(points);
  if (distance > farthest * diagonal)
    throw InvalidInput("the points lie " + to_string(Value(distance / diagonal)) +
                       " diagonals away from this " + std::string(mirror.kind()) +
                       "; the mirror must be in the unit and pose of the points");
}

}  // namespace

bool is_over_mirror(const OperationImplementation& operation, const ParameterValues& values) {
  return !operation.run_about_axis || values.choice("symmetry") != "axis";
}

OperationResult run_operation(const OperationImplementation& operation, const OperationInput& given,
                              const Mirror* mirror, const Values& parameters,
                              const Context& context) {
  const ParameterValues values(operation.name, operation.parameters, parameters);
  const bool takes_mirror = is_over_mirror(operation, values);
  if (takes_mirror && !mirror) throw InvalidInput(operation.name + " needs a mirror");
  require_count(given.points.size(), 1);
  require_coordinates(given.points);
  require_corners(given.faces, given.points.size());
  require_mask(operation, given.mask, given.points.size());
  require_pairs(operation, values, given.landmark_pairs);
  const FinitePart finite(given, operation);
  const OperationInput& input = finite.input();
  if (operation.needs_faces && input.faces.empty())
    throw InvalidInput("no faces given for " + std::to_string(input.points.size()) + " points; " +
                       operation.name + " needs a mesh of triangles");
  if (takes_mirror && !operation.takes_any_mirror) require_near(input.points, *mirror);
  OperationResult result;
  result.operation = operation.name;
  result.points = input.points.matrix();
  result.faces = Eigen::Map<const Triangles>(input.faces.data(), input.faces.size(), 3);
  result.parameters = values.all();
  context.report(0);
  if (takes_mirror)
    operation.run(input, *mirror, values, context, result);
  else
    operation.run_about_axis(input, values, context, result);
  finite.map_back(result);
  drop_nonfinite(result.statistics);
  context.report(1);
  return result;
}

namespace {

double absent(const PointArray& array) {
  if (array.type == ParameterType::Real) return std::numeric_limits<double>::quiet_NaN();
  return array.names_points || array.names_faces ? -1 : 0;
}

// The rows of the part at the places that `whole` names, over those of all.
template <class Rows, class Whole>
Rows spread(const Rows& part, const Whole& whole, Rows all) {
  for (Index i = 0; i < part.rows(); ++i) all.row(whole(i)) = part.row(i);
  return all;
}

}  // namespace

FinitePart::FinitePart(const OperationInput& whole, const Operation& operation)
    : whole_(whole), operation_(operation), part_(whole) {
  if (are_finite(whole.points)) return;
  std::vector<Index> number(whole.points.size(), -1);
  for (Index i = 0; i < whole.points.size(); ++i) {
    if (!whole.points[i].allFinite()) continue;
    number[i] = static_cast<Index>(kept_points_.size());
    kept_points_.push_back(i);
  }
  if (kept_points_.empty())
    throw InvalidInput("none of the " + std::to_string(whole.points.size()) +
                       " points given is finite; at least 1 is needed");
  for (Index f = 0; f < whole.faces.size(); ++f) {
    const Index* corner = whole.faces[f];
    if (number[corner[0]] >= 0 && number[corner[1]] >= 0 && number[corner[2]] >= 0)
      kept_faces_.push_back(f);
  }
  points_ = whole.points.matrix()(kept_points_, Eigen::indexing::all);
  faces_.resize(static_cast<Index>(kept_faces_.size()), 3);
  for (Index f = 0; f < faces_.rows(); ++f)
    for (int c = 0; c < 3; ++c) faces_(f, c) = number[whole.faces[kept_faces_[f]][c]];
  part_.own_points = std::lower_bound(kept_points_.begin(), kept_points_.end(), whole.own_points) -
                     kept_points_.begin();
  part_.points = points_;
  part_.faces = faces_;
  if (whole.mask.size() > 0) part_.mask = whole.mask(kept_points_);
}

Index FinitePart::whole_point(Index i) const {
  const Index kept = points_.rows();
  return i < kept ? kept_points_[i] : i - kept + whole_.points.size();
}

Index FinitePart::whole_face(Index f) const {
  const Index kept = faces_.rows();
  return f < kept ? kept_faces_[f] : f - kept + whole_.faces.size();
}

void FinitePart::map_back(OperationResult& result) const {
  if (kept_points_.empty()) return;
  result.statistics["nonfinite_points"] = whole_.points.size() - points_.rows();
  map_sources(result);
  if (result.point_parents.rows() > 0 && !operation_.carries_values) return;
  map_rows(result);
  map_arrays(result);
}

void FinitePart::map_sources(OperationResult& result) const {
  for (Index& i : result.point_sources) i = whole_point(i);
  for (Index& f : result.face_sources) f = whole_face(f);
  result.point_parents = result.point_parents.unaryExpr([&](Index i) { return whole_point(i); });
}

void FinitePart::map_rows(OperationResult& result) const {
  const auto point = [&](Index i) { return whole_point(i); };
  const auto face = [&](Index f) { return whole_face(f); };
  const Index points = result.points.rows() - points_.rows() + whole_.points.size();
  const Index faces = result.faces.rows() - faces_.rows() + whole_.faces.size();
  Points all_points(points, 3);
  all_points.topRows(whole_.points.size()) = whole_.points.matrix();
  result.points = spread(result.points, point, std::move(all_points));
  Triangles all_faces(faces, 3);
  all_faces.topRows(whole_.faces.size()) =
      Eigen::Map<const Triangles>(whole_.faces.data(), whole_.faces.size(), 3);
  result.faces = spread(Triangles(result.faces.unaryExpr(point)), face, std::move(all_faces));
  // What is left out is its own source.
  const auto spread_sources = [](std::vector<Index>& sources, const auto& whole, Index size) {
    if (sources.empty()) return;
    std::vector<Index> all(size);
    std::iota(all.begin(), all.end(), 0);
    for (std::size_t i = 0; i < sources.size(); ++i) all[whole(static_cast<Index>(i))] = sources[i];
    sources = std::move(all);
  };
  spread_sources(result.point_sources, point, points);
  spread_sources(result.face_sources, face, faces);
  if (result.point_parents.rows() == 0) return;
  using Parents = decltype(result.point_parents);
  using Shares = decltype(result.point_shares);
  const Index parents = result.point_parents.cols();
  Parents own = Eigen::VectorX<Index>::LinSpaced(points, 0, points - 1).replicate(1, parents);
  Shares whole_share = Shares::Zero(points, parents);
  whole_share.col(0).setOnes();
  result.point_parents = spread(result.point_parents, point, std::move(own));
  result.point_shares = spread(result.point_shares, point, std::move(whole_share));
}

void FinitePart::map_arrays(OperationResult& result) const {
  const auto point = [&](Index i) { return whole_point(i); };
  for (const PointArray& array : operation_.arrays) {
    const auto found = result.arrays.find(array.name);
    if (found == result.arrays.end()) continue;
    Eigen::MatrixXd rows = found->second;
    for (double& value : rows.reshaped()) {
      if (value < 0 || !(array.names_points || array.names_faces)) continue;
      const auto named = static_cast<Index>(value);
      value = static_cast<double>(array.names_points ? whole_point(named) : whole_face(named));
    }
    Eigen::MatrixXd all =
        Eigen::MatrixXd::Constant(result.points.rows(), rows.cols(), absent(array));
    found->second = spread(rows, point, std::move(all));
  }
}

}  // namespace symsurf
