#include "operations/mirrored_half.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "cloud/footprint.h"

namespace symsurf {

namespace {

// Points nearer to the mirror than this lie on it, in diagonals: rounding.
constexpr double on_the_mirror = 1e-9;

class Cut {
 public:
  Cut(PointsView points, const Mirror& mirror, bool positive, const Context& context)
      : points_(points),
        mirror_(mirror),
        positive_(positive),
        distances_(mirror.signed_distance(points, context)),
        near_(on_the_mirror * diagonal_of(points)),
        kept_(points.size(), -1) {
    if (!positive) distances_ = -distances_;
    if (const Index lost = distances_.array().isNaN().count(); lost > 0)
      throw InvalidInput(std::to_string(lost) + " of the " + std::to_string(points.size()) +
                         " points have no foot on this " + std::string(mirror.kind()) +
                         "; all need one");
    for (Index i = 0; i < points.size(); ++i)
      if (is_kept(i)) kept_[i] = add(points[i], {i, i, i}, Vector3::UnitX(), distances_[i] > near_);
    if (std::none_of(inside_.begin(), inside_.end(), [](bool inside) { return inside; }))
      throw InvalidInput("none of the " + std::to_string(points.size()) + " points lies on the " +
                         (positive ? "positive" : "negative") +
                         " side of the mirror; there is nothing to mirror");
  }

  // Triangles of what is left of a face.
  void add(const Index* corners, Index source) {
    std::vector<Index> polygon;
    bool any_inside = false;
    for (int k = 0; k < 3; ++k) {
      const Index a = corners[k], b = corners[(k + 1) % 3];
      if (is_kept(a)) polygon.push_back(kept_[a]);
      any_inside = any_inside || distances_[a] > near_;
      if ((distances_[a] > near_ && distances_[b] < -near_) ||
          (distances_[a] < -near_ && distances_[b] > near_))
        polygon.push_back(crossing(std::min(a, b), std::max(a, b)));
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

  MirroredHalf with_image(const Context& context) const {
    require_two_faces_an_edge();
    const auto own = static_cast<Index>(rows_.size());
    std::vector<Index> partners(own);
    Index count = own;
    for (Index i = 0; i < own; ++i) partners[i] = inside_[i] ? count++ : i;
    MirroredHalf whole;
    whole.points.resize(count, 3);
    whole.parents.resize(count, 3);
    whole.shares.resize(count, 3);
    whole.partners = partners;
    whole.partners.resize(count);
    Index without_image = 0;
    for (Index i = 0; i < own; ++i) {
      if (i % 4096 == 0) context.check();
      for (const Index row : {i, partners[i]}) {
        whole.parents.row(row) << parents_[i][0], parents_[i][1], parents_[i][2];
        whole.shares.row(row) = shares_[i].transpose();
      }
      whole.points.row(i) = rows_[i].transpose();
      if (!inside_[i]) continue;
      const Vector3 image = mirror_.reflect(rows_[i]);
      without_image += !image.allFinite();
      whole.points.row(partners[i]) = image.transpose();
      whole.partners[partners[i]] = i;
    }
    if (without_image > 0)
      throw InvalidInput(std::to_string(without_image) + " of the " + std::to_string(own) +
                         " points on the " + (positive_ ? "positive" : "negative") +
                         " side have no image over this " + std::string(mirror_.kind()) +
                         "; all need one");
    const auto faces = static_cast<Index>(faces_.size());
    whole.faces.resize(2 * faces, 3);
    for (Index f = 0; f < faces; ++f) {
      const auto& [a, b, c] = faces_[f];
      whole.faces.row(f) << a, b, c;
      whole.faces.row(faces + f) << partners[a], partners[c], partners[b];
    }
    whole.face_sources = face_sources_;
    whole.face_sources.insert(whole.face_sources.end(), face_sources_.begin(), face_sources_.end());
    return whole;
  }

 private:
  using Corners = std::array<Index, 3>;

  bool is_kept(Index i) const { return distances_[i] >= -near_; }
  const Vector3& at(Index row) const { return rows_[row]; }

  // Points that are not inside come to lie on the mirror.
  Index add(const Vector3& x, const Corners& parents, const Vector3& shares, bool inside) {
    rows_.push_back(inside ? x : mirror_.foot(x));
    parents_.push_back(parents);
    shares_.push_back(shares);
    inside_.push_back(inside);
    return static_cast<Index>(rows_.size()) - 1;
  }

  // Where the mirror crosses an edge: by secants that keep the zero between them (Dowell and
  // Jarratt 1971, the Illinois method). Of a plane the first is exact.
  Index crossing(Index a, Index b) {
    const auto [found, is_new] = crossings_.try_emplace({a, b}, 0);
    if (!is_new) return found->second;
    constexpr int most_steps = 100;
    constexpr double precision = 1e-15;  // of the edge, and of the diagonal
    const Vector3 from = points_[a], along = points_[b] - from;
    const double zero = precision * near_ / on_the_mirror;
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
    found->second = add(from + share * along, near_a ? Corners{a, b, b} : Corners{b, a, a},
                        Vector3(near_a ? 1 - share : share, near_a ? share : 1 - share, 0), false);
    return found->second;
  }

  void require_two_faces_an_edge() const {
    std::map<std::pair<Index, Index>, int> edges;
    for (const Corners& face : faces_)
      for (int k = 0; k < 3; ++k) {
        const Index a = face[k], b = face[(k + 1) % 3];
        if (inside_[a] || inside_[b]) continue;
        if (++edges[std::minmax(a, b)] < 2) continue;
        const Vector3 middle = (at(a) + at(b)) / 2;
        throw InvalidInput("two faces of this side meet in an edge on the mirror at " +
                           to_string(Value(middle)) +
                           ", which would have four with their images; one may");
      }
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
  std::vector<bool> inside_;  // not on the mirror
  std::vector<Corners> faces_;
  std::vector<Index> face_sources_;
  std::map<std::pair<Index, Index>, Index> crossings_;
};

}  // namespace

MirroredHalf mirrored_half(PointsView points, TrianglesView faces, const Mirror& mirror,
                           bool positive, const Context& context) {
  Cut cut(points, mirror, positive, context.stage(0, 0.5));
  for (Index f = 0; f < faces.size(); ++f) {
    if (f % 4096 == 0) context.check();
    cut.add(faces[f], f);
  }
  return cut.with_image(context.stage(0.5, 1));
}

}  // namespace symsurf
