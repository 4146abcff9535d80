#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "base/least_squares.h"
#include "base/parallel.h"
#include "recurring/cloud_facets.h"
#include "recurring/line_chains.h"

namespace symsurf {

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
