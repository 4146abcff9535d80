#include "operations/finite_part.h"

#include <limits>
#include <numeric>

#include "cloud/cloud.h"

namespace symsurf {

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
  if (result.is_other_shape()) return;
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
