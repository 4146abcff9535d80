#include "operations/counterparts.h"

#include <symsurf/context.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

#include "base/disjoint_sets.h"
#include "base/math.h"
#include "base/parallel.h"
#include "cloud/closest_point_on_mesh.h"
#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "cloud/surface_points.h"
#include "operations/meshes.h"

namespace symsurf {

namespace {

constexpr Index grain = 512;          // points; some ten microseconds each over a free-form mirror
constexpr double corner = 1e-9;       // a barycentric weight below this is rounding
constexpr double rim_of_mesh = 0.1;   // of the spacing and of the face's longest edge: how far past
                                      // it is on it still
constexpr double rim_of_cloud = 1.5;  // spacings: inside a surface the nearest point is nearer
constexpr Index neighbours = 10;      // that a cloud's normals are estimated from
constexpr double exact = 1e-6;        // diagonals between a point and an image: single precision

void require_images(const Points& images, std::string_view kind) {
  const Index count = images.rowwise().sum().array().isFinite().count();
  if (2 * count < images.rows())
    throw InvalidInput(
        "only " + std::to_string(count) + " of " + std::to_string(images.rows()) +
        " points have an image over this " + std::string(kind) +
        "; at least half are needed: the mirror must be in the unit and pose of the points");
}

// NaN where one is not known: of a vertex that no face uses.
double cosine_between(const Vector3& a, const Vector3& b) {
  return a.isZero(0) || b.isZero(0) ? std::numeric_limits<double>::quiet_NaN() : a.dot(b);
}

double volume_of(PointsView points, TrianglesView faces) {
  const Vector3 origin = points[0];
  double volume = 0;
  for (Index f = 0; f < faces.size(); ++f) {
    const Vector3 a = points[faces[f][0]] - origin, b = points[faces[f][1]] - origin;
    volume += a.cross(b).dot(points[faces[f][2]] - origin) / 6;
  }
  return volume;
}

// One a point: whether most of the connected part of the mesh that it belongs to faces the other
// way than what it is the image of. A side is wound so that was mirrored without turning its faces.
std::vector<bool> wound_against_their_images(PointsView points, TrianglesView faces,
                                             const std::vector<signed char>& faces_alike) {
  const DistinctPoints distinct = distinct_points(points, Context());
  DisjointSets parts(static_cast<Index>(distinct.first.size()));
  const auto part_of = [&](Index i) { return parts.root(distinct.number[i]); };
  for (Index f = 0; f < faces.size(); ++f)
    for (int c = 0; c < 2; ++c)
      parts.join(distinct.number[faces[f][c]], distinct.number[faces[f][c + 1]]);
  std::vector<Index> balance(parts.size(), 0);
  for (Index i = 0; i < points.size(); ++i) balance[part_of(i)] += faces_alike[i];
  std::vector<bool> against(points.size());
  for (Index i = 0; i < points.size(); ++i) against[i] = balance[part_of(i)] < 0;
  return against;
}

// How the map turns a normal at x, up to its sign: by what it does to two tangents, as a mirror
// need not be an isometry.
Vector3 mapped_normal(const SymmetryMap& map, const Vector3& x, const Vector3& image,
                      const Vector3& normal, double step) {
  const Vector3 u = normal.unitOrthogonal(), v = normal.cross(u);
  const Vector3 along_u = map.image(x + step * u) - image;
  const Vector3 along_v = map.image(x + step * v) - image;
  return along_u.cross(along_v).stableNormalized();
}

}  // namespace

Counterparts::Counterparts(const OperationInput& input, const SymmetryMap& map,
                           const Limits& limits, const Context& context,
                           const HomologousMatcher& homologous)
    : map_(map),
      limits_(limits),
      is_homologous_(homologous != nullptr),
      own_(input.own().size()),
      all_(input.points.size()),
      images_(map.images(input.points, context.stage(0, 0.3))) {
  require_images(images_, map.kind());
  distances_ = map.signed_distance(input.points, context.stage(0.3, 0.3));
  if (!map.is_reflection()) preimages_ = map.inverse().images(input.points, context);
  const double registered = homologous ? 0.8 : 0.3;
  if (homologous) homologous_ = homologous(input, map, images_, context.stage(0.3, 0.8));
  const Context rest = context.stage(registered, 1);
  if (input.faces.empty())
    match_cloud(input, rest);
  else
    match_mesh(input, rest);
  if (map.is_reflection()) {
    std::vector<Index> nearest;
    for (const Counterpart& c : all_) nearest.push_back(c.nearest);
    pair_copies(input.points, input.faces, nearest, context.stage(1, 1));
    for (std::size_t i = 0; i < all_.size(); ++i) all_[i].nearest = nearest[i];
  }
  if (is_by_topology()) {
    const double beside = 2 * mirror_tolerance * diagonal_of(input.points);
    for (Index i = 0; i < input.points.size(); ++i)
      if (const double side = homologous_.sides[i]; std::isfinite(side))
        distances_[i] = side * std::max(std::abs(distances_[i]), beside);
  }
  matched_ = std::count_if(all_.begin(), all_.begin() + own_,
                           [](const Counterpart& c) { return c.matched; });
}

void Counterparts::settle(Index i, double cosine) {
  Counterpart& c = all_[i];
  c.agreement = std::isfinite(cosine) ? std::clamp(cosine, 0.0, 1.0) : 1;
  c.matched = !c.past_rim && c.gap <= limits_.distance && c.agreement >= limits_.cosine;
}

// A point that is the image of another, to the rounding of single precision.
void Counterparts::settle_exact(Index i) {
  all_[i].matched = true;
  if (!is_homologous_) return;
  homologous_.deviations[i] = 0;
  homologous_.known[i] = 1;
}

double Counterparts::confidence(Index i, PointsView points) const {
  const Counterpart& c = all_[i];
  if (!c.matched) return 0;
  if (is_homologous_) return homologous_.known[i];
  double gap = (image(i) - points[c.nearest]).norm();
  if (!std::isfinite(gap)) gap = c.gap;  // a point without an image may be another's
  return gap == 0 ? c.agreement : c.agreement / (1 + gap * gap / (spacing_ * spacing_));
}

void Counterparts::report(Values& statistics) const {
  const auto share = [&](const auto& is_so) {
    const auto count = std::count_if(all_.begin(), all_.begin() + own_,
                                     [&](const Counterpart& c) { return !c.matched && is_so(c); });
    return static_cast<double>(count) / static_cast<double>(own_);
  };
  const auto has_none = [](const Counterpart& c) { return c.nearest < 0 && !c.past_rim; };
  const auto is_far = [&](const Counterpart& c) {
    return c.nearest >= 0 && !c.past_rim && c.gap > limits_.distance;
  };
  const auto is_turned = [&](const Counterpart& c) {
    return c.nearest >= 0 && !c.past_rim && c.gap <= limits_.distance;
  };
  statistics["unmatched_share"] = share([](const Counterpart&) { return true; });
  statistics["unmatched_without_image"] = share(has_none);
  statistics["unmatched_past_rim"] = share([](const Counterpart& c) { return c.past_rim; });
  statistics["unmatched_too_far"] = share(is_far);
  statistics["unmatched_turned"] = share(is_turned);
  if (!is_homologous_) return;
  for (const auto& [name, value] : homologous_.statistics) statistics[name] = value;
  const double known = median(std::vector(homologous_.known.begin(), homologous_.known.end()));
  statistics["known_share"] = known;
  if (known < 0.5 && !is_by_topology())
    statistics["warning"] =
        "the shape explains less than half of the displacement along the surface (known_share " +
        to_string(Value(known)) + "): homologous points are uncertain along it";
}

void Counterparts::match_mesh(const OperationInput& input, const Context& context) {
  const PointsView points = input.points;
  const double exact_reach = exact * diagonal_of(points);
  // Those on the mirror have none, nor have those without a foot on it.
  const double on_mirror = mirror_tolerance * diagonal_of(points);
  const auto side = [&](Index i) {
    return distances_[i] > on_mirror ? 1 : distances_[i] < -on_mirror ? -1 : 0;
  };
  // The images of the faces that reach beyond the mirror, as the points of a side look for them.
  std::array<std::optional<ClosestPointOnMesh>, 2> mirrored;
  const auto find_surface_for = [&](int own, const Context& part) {
    mirrored[own < 0].emplace(images_, input.faces, part, [&, own](Index f) {
      const Index* corners = input.faces[f];
      return map_.is_reflection()
                 ? std::any_of(corners, corners + 3, [&](Index i) { return side(i) == -own; })
                 : own > 0;
    });
  };
  std::optional<PointTree> images;
  const std::function<void(const Context&)> preparations[]{
      [&](const Context& part) { mesh_.emplace(points, input.faces, part); },
      [&](const Context& part) { find_surface_for(1, part); },
      [&](const Context& part) { find_surface_for(-1, part); },
      [&](const Context& part) { images.emplace(images_, part); }};
  parallel_for(context.stage(0, 0.2), std::size(preparations), 1,
               [&](Index k, Index) { preparations[k](context.stage(0, 0.2)); });
  const TriangleMesh& mesh = *mesh_;
  // A mirror turns the winding round.
  const double winding = map_.is_reflection() ? -1 : 1;
  Points image_normals;
  parallel_for(context.stage(0.2, 0.3), 2, 1, [&](Index k, Index) {
    if (k == 0)
      normals_ = mesh.vertex_normals();
    else
      image_normals = winding * mesh.vertex_normals(TriangleMesh::Weight::Angle, images_);
  });
  const std::vector<bool> is_boundary = mesh.is_boundary();
  spacing_ = std::sqrt(surface_area(points, input.faces) / static_cast<double>(points.size()));
  const bool is_closed = std::none_of(is_boundary.begin(), is_boundary.end(), std::identity());
  is_watertight_ = is_closed && mesh.refused().total() == 0;
  const double outwards = is_closed && volume_of(points, input.faces) < 0 ? -1 : 1;
  std::vector<Index> face_at(points.size(), -1);
  for (Index f = input.faces.size() - 1; f >= 0; --f)
    for (int c = 0; c < 3; ++c) face_at[input.faces[f][c]] = f;

  const auto ends_at_mirror = [&](Index i) {
    return is_boundary[i] && side(i) == 0 && image(i).allFinite();
  };
  std::array<bool, 3> seen{};  // sides, and an end at the mirror
  for (Index i = 0; i < points.size(); ++i)
    if (side(i) != 0 || ends_at_mirror(i)) seen[1 + side(i)] = true;
  is_half_ = map_.is_reflection() && seen[1] && seen[0] != seen[2];
  const auto closest_to = [&](Index i, const auto& search) {
    ClosestPoint closest;
    for (const int own : {1, -1})
      if (side(i) != -own)
        if (const ClosestPoint found = search(*mirrored[own < 0]);
            found.squared_distance < closest.squared_distance)
          closest = found;
    return closest;
  };
  const auto settle_at = [&](Index i, const ClosestPoint& closest, bool by_lines) {
    Counterpart& c = all_[i];
    const Vector3 x = query(points, i);
    const Index* corners = input.faces[closest.face];
    c.face = closest.face;
    c.weights = closest.weights;
    c.place = closest.point;
    c.gap = (closest.point - points[i]).norm();
    c.on_surface = Vector3::Zero();
    Vector3 normal = Vector3::Zero();
    c.on_rim = true;
    double width = 0, nearest = std::numeric_limits<double>::infinity();
    double beyond = 0;  // how far from the mirror it is the image of, on which side
    for (int k = 0; k < 3; ++k) {
      const Vector3 y = image(corners[k]);
      beyond += closest.weights[k] * distances_[corners[k]];
      c.on_surface += closest.weights[k] * points[corners[k]];
      normal += closest.weights[k] * image_normals.row(corners[k]).transpose();
      c.on_rim = c.on_rim && (closest.weights[k] < corner || is_boundary[corners[k]]);
      width = std::max(width, (image(corners[(k + 1) % 3]) - y).norm());
      const double squared = (y - x).squaredNorm();
      if (squared < nearest) {
        nearest = squared;
        c.nearest = corners[k];
      }
    }
    normal.stableNormalize();
    const Vector3 gap = x - closest.point;
    c.past_rim = c.on_rim && ((gap - gap.dot(normal) * normal).norm() >
                                  rim_of_mesh * std::min(width, spacing_) ||
                              side(i) * beyond > on_mirror);
    const double cosine = cosine_between(normal, normals_.row(i).transpose());
    settle(i, by_lines ? std::abs(cosine) : cosine);
    return cosine;
  };
  // A point that is the image of another, whatever the faces around the two.
  const auto settle_at_point = [&](Index i, Index partner, bool is_exact) {
    Counterpart& c = all_[i];
    c.nearest = partner;
    c.face = face_at[partner];
    const Index* corners = input.faces[c.face];  // may name the partner twice
    c.weights = Vector3::Unit(std::find(corners, corners + 3, partner) - corners);
    c.place = image(partner);
    c.on_surface = points[partner];
    c.gap = (c.place - points[i]).norm();
    c.on_rim = is_boundary[partner];
    const double cosine =
        cosine_between(image_normals.row(partner).transpose(), normals_.row(i).transpose());
    settle(i, std::abs(cosine));
    if (is_exact) settle_exact(i);
    return cosine;
  };

  // Whether the closest place faces the way the point does: 1 or -1; 0: neither, or not known.
  std::vector<signed char> faces_alike(points.size(), 0);
  parallel_for(context.stage(0.3, 0.9), points.size(), grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      if (is_half_ && !ends_at_mirror(i)) {
        all_[i].past_rim = image(i).allFinite();
        continue;
      }
      if (is_by_topology()) {
        if (const Index other = homologous_.partners[i]; other >= 0)
          settle_at_point(i, other, true);
        continue;
      }
      Index partner = is_half_ ? i : images->nearest(points[i], exact_reach * exact_reach).index;
      const bool is_exact = partner >= 0;
      if (!is_exact && is_homologous_) partner = homologous_.partners[i];
      const auto look = [&](double cosine) {
        if (std::abs(cosine) >= limits_.cosine) faces_alike[i] = cosine < 0 ? -1 : 1;
      };
      if (partner >= 0 && face_at[partner] >= 0) {
        look(settle_at_point(i, partner, is_exact));
        continue;
      }
      const Vector3 x = query(points, i);
      const ClosestPoint closest = closest_to(i, [&](const auto& surface) { return surface(x); });
      all_[i].past_rim = closest.face < 0 && image(i).allFinite();
      if (closest.face < 0) continue;
      const double cosine = settle_at(i, closest, false);
      if (all_[i].agreement < limits_.cosine) {
        // Where the sides of a thin part differ, the closest layer is the wrong one.
        const ClosestPoint facing = closest_to(i, [&](const auto& surface) {
          return surface.facing(x, winding * normals_.row(i).transpose(), limits_.cosine,
                                limits_.distance * limits_.distance);
        });
        if (facing.face >= 0) settle_at(i, facing, false);
      }
      if (!all_[i].past_rim && all_[i].gap <= limits_.distance) look(all_[i].matched ? 1 : cosine);
    }
  });
  const std::vector<bool> by_lines = wound_against_their_images(points, input.faces, faces_alike);
  parallel_for(context.stage(0.9, 1), points.size(), grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i)
      if (by_lines[i] && !is_by_topology() && all_[i].face >= 0 && all_[i].gap > exact_reach)
        settle_at(i, closest_to(i, [&](const auto& surface) { return surface(query(points, i)); }),
                  true);
  });
  normals_ *= outwards;
}

void Counterparts::match_cloud(const OperationInput& input, const Context& context) {
  const PointsView points = input.points;
  const PointTree tree(points, context.stage(0, 0.1));
  normals_ = estimate_normals(points, tree, std::min(neighbours, points.size()), "pca",
                              context.stage(0.1, 0.3));
  const Vector3 centroid = points.matrix().colwise().mean().transpose();
  for (Index i = 0; i < points.size(); ++i)
    if ((points[i] - centroid).dot(normals_.row(i).transpose()) < 0) normals_.row(i) *= -1;
  spacing_ = surface_spacing(points, tree);
  const double step = 1e-2 * spacing_, exact_reach = exact * diagonal_of(points);

  const PointTree mirrored(images_, context.stage(0.3, 0.4));
  parallel_for(context.stage(0.4, 1), points.size(), grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      Counterpart& c = all_[i];
      const Vector3 x = query(points, i);
      c.nearest = mirrored.nearest(x).index;
      if (c.nearest < 0) continue;
      const Vector3 y = image(c.nearest), gap = x - y;
      const Vector3 normal =
          mapped_normal(map_, points[c.nearest], y, normals_.row(c.nearest).transpose(), step);
      const Vector3 along = gap - gap.dot(normal) * normal;
      c.place = y + along;
      c.on_surface = map_.preimage(c.place);
      if (!c.on_surface.allFinite()) {  // past the points that have images
        c = {};
        continue;
      }
      c.gap = !is_homologous_ ? std::abs(gap.dot(normal)) : (c.place - points[i]).norm();
      const double own = distances_[i], other = distances_[c.nearest];
      const bool is_own_side =
          own * other > 0 && std::min(std::abs(own), std::abs(other)) > spacing_ / 2;
      c.past_rim = is_own_side || along.norm() > rim_of_cloud * spacing_;
      // Estimated normals have no sign.
      settle(i, std::abs(normal.dot(normals_.row(i).transpose())));
      if (gap.norm() <= exact_reach) settle_exact(i);
    }
  });
}

Parameter max_distance() {
  return Parameter::real(
      "max_distance", 0.1, 0, 1, "diagonal",
      "A point whose image lies farther than this from the surface has no counterpart.");
}

Parameter max_angle() {
  return Parameter::real("max_angle", 60, 0, 90, "degrees",
                         "A point whose mirrored normal differs by more than this from the normal "
                         "of the surface has no counterpart.");
}

Parameter pairing() {
  return Parameter::choice("pairing", "closest", {"closest", "homologous", "topology"},
                           "Counterpart of a point: the closest point of the mirrored surface; "
                           "the homologous one, which is the vertex that mirrors it in a symmetric "
                           "triangulation, otherwise an estimate by a Gaussian process; or that "
                           "vertex by the triangles alone, wherever a pose has put it.");
}

HomologousMatcher pairing_of(const ParameterValues& values, const Matchers& matchers) {
  const std::string& pairing = values.choice("pairing");
  return pairing == "homologous" ? matchers.homologous
         : pairing == "topology" ? matchers.topological
                                 : nullptr;
}

Counterparts::Limits limits_of(const ParameterValues& values, PointsView points) {
  // A right angle is allowed to be one to rounding.
  return {values.real("max_distance") * diagonal_of(points),
          std::cos(values.real("max_angle") * std::numbers::pi / 180) - 1e-12};
}

}  // namespace symsurf
