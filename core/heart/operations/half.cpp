#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <utility>

#include "base/math.h"
#include "cloud/cloud.h"
#include "operations/counterparts.h"
#include "operations/meshes.h"

namespace symsurf {

namespace {

class Cut {
 public:
  Cut(PointsView points, const Mirror& mirror, bool positive, const Context& context)
      : points_(points),
        mirror_(mirror),
        positive_(positive),
        distances_(mirror.signed_distance(points, context)),
        near_(mirror_tolerance * diagonal_of(points)),
        kept_(points.size(), -1) {
    if (!positive) distances_ = -distances_;
    if (const Index lost = distances_.array().isNaN().count(); lost > 0)
      throw InvalidInput(std::to_string(lost) + " of the " + std::to_string(points.size()) +
                         " points have no foot on this " + std::string(mirror.kind()) +
                         "; all need one");
    for (Index i = 0; i < points.size(); ++i)
      if (is_kept(i)) kept_[i] = add(points[i], {i, i, i}, Vector3::UnitX(), distances_[i] > near_);
    if (std::all_of(on_mirror_.begin(), on_mirror_.end(), [](bool on) { return on; }))
      throw InvalidInput("none of the " + std::to_string(points.size()) + " points lies on the " +
                         (positive ? "positive" : "negative") + " side of the mirror");
  }

  // Of all faces before any is added, so that the order of the points is not theirs.
  void add_crossings(TrianglesView faces) {
    for (Index f = 0; f < faces.size(); ++f)
      for (int k = 0; k < 3; ++k)
        if (const Index a = faces[f][k], b = faces[f][(k + 1) % 3]; is_crossed(a, b))
          crossings_[std::minmax(a, b)] = -1;
    for (auto& [edge, row] : crossings_) row = crossing(edge.first, edge.second);
  }

  // Triangles of what is left of a face; none of one that names a corner twice.
  void add(const Index* corners, Index source) {
    if (is_degenerate(corners)) return;
    std::vector<Index> polygon;
    bool any_inside = false;
    for (int k = 0; k < 3; ++k) {
      const Index a = corners[k], b = corners[(k + 1) % 3];
      if (is_kept(a)) polygon.push_back(kept_[a]);
      any_inside = any_inside || distances_[a] > near_;
      if (is_crossed(a, b)) polygon.push_back(crossings_.at(std::minmax(a, b)));
    }
    if (!any_inside) return;
    if (polygon.size() == 4) {
      const bool even =
          (at(polygon[0]) - at(polygon[2])).norm() <= (at(polygon[1]) - at(polygon[3])).norm();
      if (!even) std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
      faces_.push_back({polygon[2], polygon[3], polygon[0]});
      face_sources_.push_back(source);
    }
    faces_.push_back({polygon[0], polygon[1], polygon[2]});
    face_sources_.push_back(source);
  }

  Half half() {
    return {rows_of(rows_),   rows_of(faces_),          rows_of(parents_),
            rows_of(shares_), std::move(face_sources_), std::move(on_mirror_)};
  }

 private:
  using Corners = std::array<Index, 3>;

  bool is_kept(Index i) const { return distances_[i] >= -near_; }
  bool is_crossed(Index a, Index b) const {
    return std::max(distances_[a], distances_[b]) > near_ &&
           std::min(distances_[a], distances_[b]) < -near_;
  }
  const Vector3& at(Index row) const { return rows_[row]; }

  // Points that are not inside come to lie on the mirror.
  Index add(const Vector3& x, const Corners& parents, const Vector3& shares, bool inside) {
    rows_.push_back(inside ? x : mirror_.foot(x));
    parents_.push_back(parents);
    shares_.push_back(shares);
    on_mirror_.push_back(!inside);
    return static_cast<Index>(rows_.size()) - 1;
  }

  // Where the mirror crosses an edge: by secants that keep the zero between them (Dowell and
  // Jarratt 1971, the Illinois method). Of a plane the first is exact.
  Index crossing(Index a, Index b) {
    constexpr int most_steps = 100;
    constexpr double precision = 1e-15;  // of the edge, and of the diagonal
    // From the same end of copies of an edge, so that they cross at the same bits.
    const auto coordinates = [&](Index i) { return std::span(points_.data() + 3 * i, 3); };
    if (std::ranges::lexicographical_compare(coordinates(b), coordinates(a))) std::swap(a, b);
    const Vector3 from = points_[a], along = points_[b] - from;
    const double zero = precision * near_ / mirror_tolerance;
    double low = 0, high = 1, at_low = distances_[a], at_high = distances_[b], share = 0.5;
    int last = 0;  // which end moved: -1 the low one, 1 the high one
    for (int step = 0; step < most_steps && high - low > precision; ++step) {
      share = low + (high - low) * at_low / (at_low - at_high);
      const double distance = mirror_.signed_distance(Vector3(from + share * along));
      const double here = positive_ ? distance : -distance;
      if (!(std::abs(here) > zero)) break;
      if ((here > 0) == (at_low > 0)) {
        low = share;
        at_low = here;
        if (last == -1) at_high /= 2;
        last = -1;
      } else {
        high = share;
        at_high = here;
        if (last == 1) at_low /= 2;
        last = 1;
      }
    }
    const bool near_a = share <= 0.5;
    return add(from + share * along, near_a ? Corners{a, b, b} : Corners{b, a, a},
               Vector3(near_a ? 1 - share : share, near_a ? share : 1 - share, 0), false);
  }

  PointsView points_;
  const Mirror& mirror_;
  bool positive_;
  Eigen::VectorXd distances_;  // positive on the side that is kept
  double near_;
  std::vector<Index> kept_;  // of each point of the shape its row, or -1
  std::vector<Vector3> rows_;
  std::vector<Corners> parents_;
  std::vector<Vector3> shares_;
  std::vector<bool> on_mirror_;
  std::vector<Corners> faces_;
  std::vector<Index> face_sources_;
  std::map<std::pair<Index, Index>, Index> crossings_;
};

}  // namespace

Half half_of(PointsView points, TrianglesView faces, const Mirror& mirror, bool positive,
             const Context& context) {
  Cut cut(points, mirror, positive, context);
  cut.add_crossings(faces);
  for (Index f = 0; f < faces.size(); ++f) {
    if (f % 4096 == 0) context.check();
    cut.add(faces[f], f);
  }
  Half half = cut.half();
  if (!half.points.allFinite())
    throw InvalidInput("some points where this " + std::string(mirror.kind()) +
                       " cuts the shape have no foot on it; all need one");
  return half;
}

std::vector<std::pair<Index, Index>> cut_edges(const Triangles& faces,
                                               const std::vector<bool>& on_mirror) {
  // How many faces each has, and how many more of them run up from its lower vertex than down.
  std::map<std::pair<Index, Index>, std::pair<int, int>> edges;
  for (const auto& face : faces.rowwise()) {
    if (is_degenerate(face.data())) continue;
    for (int k = 0; k < 3; ++k) {
      const Index a = face[k], b = face[(k + 1) % 3];
      if (!on_mirror[a] || !on_mirror[b]) continue;
      auto& [count, up] = edges[std::minmax(a, b)];
      ++count;
      up += a < b ? 1 : -1;
    }
  }
  std::vector<std::pair<Index, Index>> found;
  for (const auto& [edge, own] : edges)
    if (own.first % 2 == 1)
      found.push_back(own.second > 0 ? edge : std::pair(edge.second, edge.first));
  return found;
}

MirroredHalf with_image(Half half, const Mirror& mirror, const Context& context) {
  MirroredHalf whole{std::move(half), {}};
  const Index own = whole.points.rows(), faces = whole.faces.rows();
  std::vector<Index> partners(own);
  Index count = own;
  for (Index i = 0; i < own; ++i) partners[i] = whole.on_mirror[i] ? i : count++;
  whole.points.conservativeResize(count, 3);
  whole.parents.conservativeResize(count, 3);
  whole.shares.conservativeResize(count, 3);
  whole.on_mirror.resize(count, false);
  whole.partners = partners;
  whole.partners.resize(count);
  const Points images = mirror.reflect(whole.points.topRows(own).eval(), context);
  Index without_image = 0;
  for (Index i = 0; i < own; ++i) {
    if (partners[i] == i) continue;
    without_image += !images.row(i).allFinite();
    whole.points.row(partners[i]) = images.row(i);
    whole.parents.row(partners[i]) = whole.parents.row(i);
    whole.shares.row(partners[i]) = whole.shares.row(i);
    whole.partners[partners[i]] = i;
  }
  if (without_image > 0)
    throw InvalidInput(std::to_string(without_image) + " of the " + std::to_string(own) +
                       " points of the side have no image over this " + std::string(mirror.kind()) +
                       "; all need one");
  whole.faces.conservativeResize(2 * faces, 3);
  for (Index f = 0; f < faces; ++f) {
    const auto face = whole.faces.row(f);
    whole.faces.row(faces + f) << partners[face[0]], partners[face[2]], partners[face[1]];
    whole.face_sources.push_back(whole.face_sources[f]);
  }
  return whole;
}

Parameter kept_side() {
  return Parameter::choice(
      "side", "positive", {"positive", "negative"},
      "Side to keep: where the signed distance from the mirror is positive or negative.");
}

bool keeps_positive(const ParameterValues& values) { return values.choice("side") == "positive"; }

void set_shape(Half half, OperationResult& result) {
  for (Index i = 0; i < half.points.rows(); ++i) result.point_sources.push_back(half.parents(i, 0));
  result.points = std::move(half.points);
  result.faces = std::move(half.faces);
  result.face_sources = std::move(half.face_sources);
  result.point_parents = half.parents;
  result.point_shares = half.shares;
}

void set_shape(MirroredHalf whole, OperationResult& result) {
  result.arrays["partner"] =
      Eigen::Map<const Eigen::VectorX<Index>>(whole.partners.data(), whole.points.rows())
          .cast<double>();
  set_shape(static_cast<Half&&>(whole), result);
}

}  // namespace symsurf
