#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <unordered_map>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "cloud/voxel_grid.h"
#include "recurring/recurring_parts.h"

namespace symsurf {

namespace {

// An edge with its faces and the unit vectors across it into these.
struct MeshEdge {
  Index from, to;
  std::vector<Index> faces;
  std::vector<Vector3> wings;
  bool is_vague = false;  // beside a face without an area
  Index border = -1;
};

// Where the same facets meet: their planes beside it.
struct Border {
  std::vector<Index> facets, edges;
  std::vector<FacetPlane> sides;
  double error = 0;  // radians, of the planes
  bool is_sharp = true;
};

class LineExtraction {
 public:
  LineExtraction(PointsView points, TrianglesView faces, double angle, const Context& context)
      : points_(points), angle_(angle) {
    TripleIndex positions;
    std::vector<Index> place(points.size());
    for (Index i = 0; i < points.size(); ++i) {
      place[i] = positions.add(ordered_bits(points[i]));
      if (place[i] == static_cast<Index>(positions_.size())) positions_.push_back(points[i]);
    }
    find_edges(faces, place, context);
    find_facets(context);
    find_borders(context);
    edges_at_.resize(positions_.size());
    for (std::size_t e = 0; e < edges_.size(); ++e)
      if (is_sharp(edges_[e])) {
        edges_at_[edges_[e].from].push_back(static_cast<Index>(e));
        edges_at_[edges_[e].to].push_back(static_cast<Index>(e));
      }
    if (noise_ > 0) move_onto_crests();
    for (Index i = 0; i < points.size(); ++i)
      if (!edges_at_[place[i]].empty()) twins_[place[i]].push_back(i);
  }

  FeatureLines run(const Context& context) {
    FeatureLines found;
    found.noise = noise_;
    const auto count = static_cast<Index>(positions_.size());
    std::vector<Index> corner(count, -1);
    for (Index place = 0; place < count; ++place)
      if (is_corner(place)) {
        corner[place] = static_cast<Index>(found.corners.size());
        found.corners.push_back(positions_[place]);
      }
    std::vector<std::array<Index, 2>> ends(edges_.size(), {-1, -1});
    for (std::size_t e = 0; e < edges_.size(); ++e)
      if (is_sharp(edges_[e])) ends[e] = {edges_[e].from, edges_[e].to};
    context.check();
    for (const LineChain& chain : line_chains(ends, edges_at_, corner))
      found.lines.push_back(line_of(chain, corner));
    return found;
  }

 private:
  Index other_end(Index edge, Index place) const {
    return edges_[edge].from == place ? edges_[edge].to : edges_[edge].from;
  }
  bool is_sharp(const MeshEdge& edge) const {
    return edge.border >= 0 && borders_[edge.border].is_sharp;
  }

  void find_edges(TrianglesView faces, const std::vector<Index>& place, const Context& context) {
    TripleIndex edges, known;
    interruptible_for(context, faces.size(), [&](Index f) {
      const Triple corners{place[faces[f][0]], place[faces[f][1]], place[faces[f][2]]};
      Triple sorted = corners;
      std::sort(sorted.begin(), sorted.end());
      if (sorted[0] == sorted[1] || sorted[1] == sorted[2]) return;
      const Index face = known.add(sorted);
      if (face < static_cast<Index>(faces_.size())) return;  // the same face again
      faces_.push_back({corners[0], corners[1], corners[2]});
      for (int c = 0; c < 3; ++c) {
        const Index from = std::min(corners[c], corners[(c + 1) % 3]),
                    to = std::max(corners[c], corners[(c + 1) % 3]);
        const Index number = edges.add({from, to, 0});
        if (number == static_cast<Index>(edges_.size())) edges_.push_back({from, to, {}, {}});
        MeshEdge& edge = edges_[number];
        const Vector3 along = (positions_[to] - positions_[from]).normalized();
        const Vector3 into = positions_[corners[(c + 2) % 3]] - positions_[from];
        const Vector3 across = into - into.dot(along) * along;
        constexpr double vanishing = 1e-9;
        edge.is_vague = edge.is_vague || across.norm() <= vanishing * into.norm();
        edge.faces.push_back(face);
        edge.wings.push_back(across.normalized());
      }
    });
  }

  void find_facets(const Context& context) {
    pieces_.points = faces_;
    for (const std::vector<Index>& face : faces_)
      pieces_.moments.push_back(SurfaceMoments::of_triangle(
          positions_[face[0]], positions_[face[1]], positions_[face[2]]));
    for (const MeshEdge& edge : edges_)
      for (std::size_t k = 1; k < edge.faces.size(); ++k)
        pieces_.adjacent.emplace_back(edge.faces[0], edge.faces[k]);
    const Points rows = rows_of(positions_);
    noise_ = has_exact_planes() ? 0 : noise_of(rows, pieces_, context.stage(0, 0.4));
    if (noise_ < coordinate_rounding) noise_ = 0;
    facet_ = facets_of(rows, pieces_, noise_, context.stage(0.4, 0.8));
    neighbours_.resize(faces_.size());
    for (const auto& [a, b] : pieces_.adjacent)
      if (facet_[a] == facet_[b]) {
        neighbours_[a].push_back(b);
        neighbours_[b].push_back(a);
      }
  }

  // Whether many faces lie in one plane to rounding, as they do without noise.
  bool has_exact_planes() const {
    constexpr double within = 5e-9, many = 0.05;  // 1 - cosine: 1e-4 radians; of the edges
    const auto exact = std::count_if(edges_.begin(), edges_.end(), [&](const MeshEdge& edge) {
      return edge.wings.size() == 2 && 1 + edge.wings[0].dot(edge.wings[1]) < within;
    });
    return static_cast<double>(exact) > many * static_cast<double>(edges_.size());
  }

  void find_borders(const Context& context) {
    std::map<std::vector<Index>, Index> number;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      MeshEdge& edge = edges_[e];
      std::vector<Index> facets;
      for (const Index face : edge.faces) facets.push_back(facet_[face]);
      if (edge.is_vague || (facets.size() == 2 && facets[0] == facets[1])) continue;
      std::sort(facets.begin(), facets.end());
      const auto [entry, is_new] = number.emplace(facets, static_cast<Index>(borders_.size()));
      if (is_new) borders_.push_back({facets, {}, {}});
      edge.border = entry->second;
      borders_[edge.border].edges.push_back(static_cast<Index>(e));
    }
    mark_.assign(faces_.size(), -1);
    for (Border& border : borders_) {
      context.check();
      for (const Index facet : border.facets) border.sides.push_back(plane_beside(border, facet));
      border.is_sharp = border.facets.size() != 2 || bend_of(border) > angle_;
    }
  }

  // The plane through the faces of a facet at the border and as many rings of others as it takes
  // for noise to turn it little.
  FacetPlane plane_beside(Border& border, Index facet) {
    const Index round = rounds_++;
    std::vector<Index> found;
    SurfaceMoments moments;
    const auto add = [&](Index face) {
      if (facet_[face] != facet || mark_[face] == round) return;
      mark_[face] = round;
      found.push_back(face);
      moments += pieces_.moments[face];
    };
    for (const Index edge : border.edges)
      for (const Index face : edges_[edge].faces) add(face);
    FacetPlane plane = plane_of(moments);
    std::size_t begin = 0;
    const auto error = [&] { return noise_ > 0 ? noise_ * plane.turned : 0; };
    while (error() > certain && begin < found.size()) {
      const std::size_t end = found.size();
      for (; begin < end; ++begin)
        for (const Index next : neighbours_[found[begin]]) add(next);
      plane = plane_of(moments);
    }
    border.error = std::max(border.error, error());
    return plane;
  }

  double bend_of(const Border& border) const {
    const Vector3 &one = border.sides[0].normal, &other = border.sides[1].normal;
    const double plain = std::atan2(one.cross(other).norm(), std::abs(one.dot(other)));
    double folded = 0;
    for (const Index e : border.edges) {
      const MeshEdge& edge = edges_[e];
      folded +=
          (positions_[edge.to] - positions_[edge.from]).norm() * edge.wings[0].dot(edge.wings[1]);
    }
    return folded > 0 ? std::numbers::pi - plain : plain;
  }

  // Each place onto the planes that meet there, as far as noise may have moved it.
  void move_onto_crests() {
    std::vector<Vector3> moved = positions_;
    for (std::size_t place = 0; place < positions_.size(); ++place) {
      if (edges_at_[place].empty()) continue;
      constexpr double kept = 0.01;  // of the place where it is, to a plane
      Matrix3 normal = kept * Matrix3::Identity();
      Vector3 right = Vector3::Zero();
      for (const Index edge : edges_at_[place])
        for (const FacetPlane& side : borders_[edges_[edge].border].sides) {
          normal += side.normal * side.normal.transpose();
          right += side.normal * side.normal.dot(side.centroid - positions_[place]);
        }
      const Vector3 way = normal.inverse() * right;
      double most = farthest * noise_;
      for (const Index edge : edges_at_[place])
        most = std::max(most, (positions_[edges_[edge].to] - positions_[edges_[edge].from]).norm());
      moved[place] += std::min(1.0, most / way.norm()) * way;
    }
    positions_ = std::move(moved);
  }

  // The direction of a line from a place, over a stretch that noise does not turn.
  Vector3 tangent(Index place, Index edge) const {
    Index at = place;
    for (int steps = 0; steps < 1000; ++steps) {
      at = other_end(edge, at);
      const std::vector<Index>& next = edges_at_[at];
      if ((positions_[at] - positions_[place]).norm() > stretch * noise_ || next.size() != 2 ||
          at == place)
        break;
      edge = next[next[0] == edge ? 1 : 0];
    }
    return (positions_[at] - positions_[place]).normalized();
  }

  bool is_corner(Index place) const {
    const std::vector<Index>& edges = edges_at_[place];
    if (edges.empty()) return false;
    if (edges.size() != 2) return true;
    const MeshEdge &one = edges_[edges[0]], &other = edges_[edges[1]];
    if (one.faces.size() != other.faces.size()) return true;
    if (noise_ > 0 && one.border == other.border && one.faces.size() > 1) return false;
    return -tangent(place, edges[0]).dot(tangent(place, edges[1])) < std::cos(angle_);
  }

  FeatureLine line_of(const LineChain& chain, const std::vector<Index>& corner) const {
    const std::vector<Index>& places = chain.nodes;
    FeatureLine line;
    line.start = corner[places.front()];
    line.end = corner[places.back()];
    sample(line, places, chain.edges);
    for (const Index place : places) {
      const std::vector<Index>& twins = twins_.at(place);
      line.points.insert(line.points.end(), twins.begin(), twins.end());
    }
    std::sort(line.points.begin(), line.points.end());
    line.points.erase(std::unique(line.points.begin(), line.points.end()), line.points.end());
    return line;
  }

  void sample(FeatureLine& line, const std::vector<Index>& places,
              const std::vector<Index>& edges) const {
    std::vector<Vector3> nodes{positions_[places[0]]};
    std::vector<Index> edge_to{-1};
    for (std::size_t k = 1; k < places.size(); ++k) {
      const Vector3& x = positions_[places[k]];
      const bool is_last = k + 1 == places.size();
      const double apart = stretch * noise_;
      const auto goes_back = [&] {
        const std::size_t n = nodes.size();
        return n > 1 && ((is_last && (x - nodes[n - 1]).norm() < apart) ||
                         (noise_ > 0 && (x - nodes[n - 1]).dot(nodes[n - 1] - nodes[n - 2]) < 0));
      };
      while (goes_back()) {
        nodes.pop_back();
        edge_to.pop_back();
      }
      if (!is_last && (x - nodes.back()).norm() < apart) continue;
      nodes.push_back(x);
      edge_to.push_back(edges[k - 1]);
    }
    const std::size_t k = sample_along(nodes, line);
    const Border& border = borders_[edges_[edge_to[k]].border];
    line.wing_error = border.error;
    const Vector3 along = (nodes[k] - nodes[k - 1]).normalized();
    line.wings = wings_of(border, along, edges);
  }

  // Across the line in the planes beside it, to the side where most of the faces' area is.
  std::vector<Vector3> wings_of(const Border& border, const Vector3& along,
                                const std::vector<Index>& edges) const {
    std::vector<Vector3> wings;
    for (std::size_t side = 0; side < border.sides.size(); ++side)
      wings.push_back(border.sides[side].normal.cross(along).normalized());
    std::vector<double> same(wings.size(), 0);
    for (const Index e : edges) {
      const MeshEdge& edge = edges_[e];
      if (edge.border != static_cast<Index>(&border - borders_.data())) continue;
      for (std::size_t k = 0; k < edge.faces.size(); ++k)
        for (std::size_t side = 0; side < wings.size(); ++side)
          if (border.facets[side] == facet_[edge.faces[k]])
            same[side] += edge.wings[k].dot(wings[side]) * pieces_.moments[edge.faces[k]].area;
    }
    for (std::size_t side = 0; side < wings.size(); ++side)
      if (same[side] < 0) wings[side] *= -1;
    return wings;
  }

  // Standard deviations of the noise: how far a place is moved, how long a stretch has a direction.
  // And radians that a plane may be uncertain by.
  static constexpr double farthest = 4, stretch = 6, certain = 0.05;

  PointsView points_;
  double angle_, noise_ = 0;
  std::vector<Vector3> positions_;
  std::vector<std::vector<Index>> faces_, neighbours_, edges_at_;
  std::vector<MeshEdge> edges_;
  SurfacePieces pieces_;
  std::vector<Index> facet_, mark_;
  std::vector<Border> borders_;
  Index rounds_ = 0;
  std::unordered_map<Index, std::vector<Index>> twins_;  // all points at the places of edges
};

// Lines that are shorter than noise moves their ends become corners.
FeatureLines without_short_lines(FeatureLines graph, double shortest) {
  const auto count = static_cast<Index>(graph.corners.size());
  DisjointSets joined(count);
  std::vector<FeatureLine> kept;
  for (FeatureLine& line : graph.lines) {
    if (line.length >= shortest) {
      kept.push_back(std::move(line));
    } else if (line.has_ends()) {
      const Index a = joined.root(line.start), b = joined.root(line.end);
      joined.join(std::min(a, b), std::max(a, b));
    }
  }
  std::vector<Vector3> sum(count, Vector3::Zero());
  std::vector<double> members(count, 0);
  for (Index k = 0; k < count; ++k) {
    sum[joined.root(k)] += graph.corners[k];
    ++members[joined.root(k)];
  }
  for (Index k = 0; k < count; ++k) graph.corners[k] = sum[k] / std::max(1.0, members[k]);
  graph.lines = std::move(kept);
  for (FeatureLine& line : graph.lines) {
    if (!line.has_ends()) continue;
    line.start = joined.root(line.start);
    line.end = joined.root(line.end);
    line.samples[0] = graph.corners[line.start];
  }
  connect(graph);
  return graph;
}

}  // namespace

FeatureLines feature_lines(PointsView points, TrianglesView faces, double angle,
                           const Context& context) {
  FeatureLines graph =
      LineExtraction(points, faces, angle, context.stage(0, 0.9)).run(context.stage(0.9, 1));
  constexpr double shortest = 4;  // standard deviations of the noise
  const double least = shortest * graph.noise;
  return without_short_lines(std::move(graph), least);
}

namespace {

// Spacings: how far links between points of two facets may lie from the line in which these cross,
// and from one another along it; how far a line may end before its corner; corners that are one.
constexpr double off_line = 2, gap = 6, at_corner = 6, same_corner = 1;

// Spacings: as noise, what random points leave lines uncertain by.
constexpr double uncertain = 0.05;

// The stretch of a line in which two facets meet.
struct Crease {
  std::array<Index, 2> facets;
  std::array<Vector3, 2> ends, wings;  // wings: across it into the facets
  std::array<Index, 2> corners{-1, -1};

  Index other(Index facet) const { return facets[facets[0] == facet ? 1 : 0]; }
};

class CloudLines {
 public:
  CloudLines(const CloudFacets& cloud, double angle) : cloud_(cloud), angle_(angle) {}

  FeatureLines run(const Context& context) {
    find_creases(context.stage(0, 0.8));
    find_corners(context.stage(0.8, 1));
    return lines();
  }

 private:
  using Facets = std::array<Index, 2>;  // ascending
  using Link = std::array<Index, 2>;    // neighbours, one of each facet

  double spacing() const { return cloud_.surface.spacing; }

  void find_creases(const Context& context) {
    std::map<Facets, std::vector<Link>> links;
    interruptible_for(context, cloud_.surface.size(), [&](Index i) {
      const Index own = cloud_.facet[i];
      if (own < 0) return;
      for (const Index j : cloud_.surface.neighbours.row(i)) {
        const Index other = cloud_.facet[j];
        if (other < 0 || other == own) continue;
        if (own < other)
          links[{own, other}].push_back({i, j});
        else
          links[{other, own}].push_back({j, i});
      }
    });
    for (const auto& [facets, pairs] : links) {
      touching_.insert(facets);
      const Vector3 &one = cloud_.planes[facets[0]].normal, &two = cloud_.planes[facets[1]].normal;
      const Vector3 across = one.cross(two);
      if (std::atan2(across.norm(), std::abs(one.dot(two))) > angle_)
        add_creases(facets, across.normalized(), pairs);
    }
  }

  // From x to where the planes cross: the nearest point of two, as good as that of three.
  Vector3 crossing(std::initializer_list<Index> facets, const Vector3& x) const {
    constexpr double kept = 1e-3;  // of the place where it is, to a plane
    Matrix3 normal = kept * kept * Matrix3::Identity();
    Vector3 right = Vector3::Zero();
    for (const Index facet : facets) {
      const FacetPlane& plane = cloud_.planes[facet];
      normal += plane.normal * plane.normal.transpose();
      right += plane.normal * plane.normal.dot(plane.centroid - x);
    }
    return x + solved(normal, right);
  }

  // One for each stretch along which links follow one another.
  void add_creases(const Facets& facets, const Vector3& along, const std::vector<Link>& pairs) {
    const auto& surface = cloud_.surface;
    const Vector3 start =
        crossing({facets[0], facets[1]},
                 (surface.point(pairs.front()[0]) + surface.point(pairs.front()[1])) / 2);
    struct Place {
      double at;
      std::array<Vector3, 2> sides;  // from the line's start
    };
    std::vector<Place> places;
    for (const auto& [i, j] : pairs) {
      const Vector3 one = surface.point(i) - start, two = surface.point(j) - start,
                    middle = (one + two) / 2;
      const double at = middle.dot(along);
      if ((middle - at * along).norm() < off_line * spacing()) places.push_back({at, {one, two}});
    }
    std::stable_sort(places.begin(), places.end(),
                     [](const Place& a, const Place& b) { return a.at < b.at; });
    for (std::size_t begin = 0, end = 1; begin < places.size(); begin = end++) {
      while (end < places.size() && places[end].at - places[end - 1].at < gap * spacing()) ++end;
      Crease crease{
          facets, {start + places[begin].at * along, start + places[end - 1].at * along}, {}};
      for (int side = 0; side < 2; ++side) {
        Vector3 into = Vector3::Zero();
        for (std::size_t k = begin; k < end; ++k) into += places[k].sides[side];
        const Vector3 wing = cloud_.planes[facets[side]].normal.cross(along);
        crease.wings[side] = wing.dot(into) < 0 ? Vector3(-wing) : wing;
      }
      creases_.push_back(crease);
    }
  }

  // Creases end where three facets that touch one another cross, or before.
  void find_corners(const Context& context) {
    std::map<Index, std::vector<Index>> creases_of;
    for (std::size_t k = 0; k < creases_.size(); ++k)
      for (const Index facet : creases_[k].facets)
        creases_of[facet].push_back(static_cast<Index>(k));
    for (const auto& [facet, creases] : creases_of)
      for (std::size_t a = 0; a < creases.size(); ++a) {
        context.check();
        for (std::size_t b = a + 1; b < creases.size(); ++b) meet(facet, creases[a], creases[b]);
      }
    std::stable_sort(meetings_.begin(), meetings_.end(),
                     [](const Meeting& a, const Meeting& b) { return a.distance < b.distance; });
    for (const Meeting& each : meetings_) {
      std::array<Index, 2>& corners = creases_[each.crease].corners;
      if (corners[each.end] < 0 && corners[1 - each.end] != each.corner)
        corners[each.end] = each.corner;
    }
    // Short ones that end before are where facets share but a corner.
    std::erase_if(creases_, [&](const Crease& crease) {
      return std::min(crease.corners[0], crease.corners[1]) < 0 &&
             (crease.ends[1] - crease.ends[0]).norm() < at_corner * spacing();
    });
    for (Crease& crease : creases_)
      for (int end = 0; end < 2; ++end)
        if (crease.corners[end] < 0) {
          crease.corners[end] = static_cast<Index>(corners_.size());
          corners_.push_back(crease.ends[end]);
        }
  }

  // Whether two creases of a facet have ends at the corner with their other facets.
  void meet(Index facet, Index a, Index b) {
    const Index one = creases_[a].other(facet), two = creases_[b].other(facet);
    for (const int end_a : {0, 1})
      for (const int end_b : {0, 1}) {
        const Vector3 &p = creases_[a].ends[end_a], &q = creases_[b].ends[end_b];
        if ((p - q).norm() > 2 * at_corner * spacing() || one == two ||
            !touching_.count({std::min(one, two), std::max(one, two)}))
          continue;
        const Vector3 x = crossing({facet, one, two}, (p + q) / 2);
        const double from_a = (x - p).norm(), from_b = (x - q).norm();
        if (std::max(from_a, from_b) > at_corner * spacing()) continue;
        const Index corner = corner_at(x, {facet, one, two});
        meetings_.push_back({from_a, a, end_a, corner});
        meetings_.push_back({from_b, b, end_b, corner});
      }
  }

  // Four facets and more that meet have one corner, whichever three tell it.
  Index corner_at(const Vector3& x, std::initializer_list<Index> facets) {
    for (const Index facet : facets)
      for (const Index corner : corners_of_[facet])
        if ((corners_[corner] - x).norm() < same_corner * spacing()) return corner;
    for (const Index facet : facets)
      corners_of_[facet].push_back(static_cast<Index>(corners_.size()));
    corners_.push_back(x);
    return static_cast<Index>(corners_.size()) - 1;
  }

  // Creases that go on as another with little of a bend are one line with it.
  FeatureLines lines() const {
    std::vector<std::array<Index, 2>> ends;
    std::vector<std::vector<Index>> at(corners_.size());
    for (std::size_t k = 0; k < creases_.size(); ++k) {
      ends.push_back(creases_[k].corners);
      for (const Index corner : ends.back()) at[corner].push_back(static_cast<Index>(k));
    }
    FeatureLines found;
    found.noise = std::max(cloud_.noise, uncertain * spacing());
    std::vector<Index> number(corners_.size(), -1);
    for (std::size_t c = 0; c < corners_.size(); ++c) {
      const auto direction = [&](Index crease) {
        const Index other = ends[crease][ends[crease][0] == static_cast<Index>(c) ? 1 : 0];
        return Vector3((corners_[other] - corners_[c]).normalized());
      };
      if (at[c].empty() ||
          (at[c].size() == 2 && -direction(at[c][0]).dot(direction(at[c][1])) > std::cos(angle_)))
        continue;
      number[c] = static_cast<Index>(found.corners.size());
      found.corners.push_back(corners_[c]);
    }
    for (const LineChain& chain : line_chains(ends, at, number)) {
      FeatureLine line;
      line.start = number[chain.nodes.front()];
      line.end = number[chain.nodes.back()];
      std::vector<Vector3> nodes;
      for (const Index node : chain.nodes) nodes.push_back(corners_[node]);
      const Crease& middle = creases_[chain.edges[sample_along(nodes, line) - 1]];
      line.wings.assign(middle.wings.begin(), middle.wings.end());
      for (const Index facet : middle.facets)
        line.wing_error = std::max(line.wing_error, found.noise * cloud_.planes[facet].turned);
      for (const Vector3& x : line.samples)
        line.points.push_back(cloud_.rows[cloud_.surface.tree.nearest(x).index]);
      std::sort(line.points.begin(), line.points.end());
      line.points.erase(std::unique(line.points.begin(), line.points.end()), line.points.end());
      found.lines.push_back(std::move(line));
    }
    connect(found);
    return found;
  }

  // An end of a crease, and how far from it a corner lies.
  struct Meeting {
    double distance;
    Index crease;
    int end;
    Index corner;
  };

  const CloudFacets& cloud_;
  double angle_;
  std::set<Facets> touching_;
  std::vector<Crease> creases_;
  std::vector<Vector3> corners_;
  std::map<Index, std::vector<Index>> corners_of_;  // by facet
  std::vector<Meeting> meetings_;
};

}  // namespace

FeatureLines feature_lines(const CloudFacets& cloud, double angle, const Context& context) {
  return CloudLines(cloud, angle).run(context);
}

}  // namespace symsurf
