#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "cloud/cloud.h"
#include "recurring/recurring_parts.h"

namespace symsurf {

SurfaceMoments SurfaceMoments::of_point(const Vector3& x) { return {1, 1, x, x * x.transpose()}; }

SurfaceMoments SurfaceMoments::of_triangle(const Vector3& a, const Vector3& b, const Vector3& c) {
  SurfaceMoments moments;
  moments.pieces = 1;
  moments.area = (b - a).cross(c - a).norm() / 2;
  const Vector3 sum = a + b + c;
  moments.sum = moments.area / 3 * sum;
  moments.products =
      moments.area / 12 *
      (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  return moments;
}

SurfaceMoments& SurfaceMoments::operator+=(const SurfaceMoments& other) {
  area += other.area;
  pieces += other.pieces;
  sum += other.sum;
  products += other.products;
  return *this;
}

FacetPlane plane_of(const SurfaceMoments& moments) {
  const LeastEigen eigen = least_eigen_of(moments.scatter());
  return {moments.centroid(), eigen.vector.normalized(),
          std::sqrt(moments.area / (eigen.next * moments.pieces))};
}

std::vector<std::vector<Index>> members_of(const std::vector<Index>& group) {
  std::vector<std::vector<Index>> members;
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (group[i] < 0) continue;
    const auto own = static_cast<std::size_t>(group[i]);
    if (own >= members.size()) members.resize(own + 1);
    members[own].push_back(static_cast<Index>(i));
  }
  return members;
}

namespace {

// Chosen on facades and gears with noise of 0.1 % (`make accuracy OPTIONS="--cases recurring"`), as
// those in the header. In standard deviations of the noise, in the mean of squares: how far facets
// that merge may lie off their plane.
constexpr double flat = 1.4;

// Greedy merging with a heap of the pairs that touch; costs are renewed when their turn comes.
class Merging {
 public:
  explicit Merging(const std::vector<SurfaceMoments>& pieces)
      : moments_(pieces), facets_(static_cast<Index>(pieces.size())), age_(pieces.size(), 0) {
    for (const SurfaceMoments& piece : pieces) bend_.push_back(bend(piece));
  }

  // Until no pair of facets, one of which at least may take others, costs up to `limit`.
  template <typename IsOpen>
  void run(const Adjacency& adjacent, double limit, const IsOpen& is_open, const Context& context) {
    const auto closed = [&](Index a, Index b) {
      return a == b || !is_open(moments_[a], moments_[b]);
    };
    std::priority_queue<Pair> pairs;
    const auto push = [&](Index a, Index b) {
      if (closed(a, b)) return;
      const double now = cost(a, b);
      if (now <= limit) pairs.push({now, a, b, age_[a] + age_[b]});
    };
    for (std::size_t begin = 0; begin < adjacent.size(); begin += stretch) {
      context.check();
      for (std::size_t k = begin; k < std::min(adjacent.size(), begin + stretch); ++k)
        push(facets_.root(adjacent[k].first), facets_.root(adjacent[k].second));
    }
    for (std::size_t step = 0; !pairs.empty(); ++step) {
      if (step % stretch == 0) context.check();
      const Pair next = pairs.top();
      pairs.pop();
      const Index a = facets_.root(next.a), b = facets_.root(next.b);
      if (closed(a, b)) continue;
      if (age_[a] + age_[b] != next.age) {
        const double now = cost(a, b);
        if (now > limit) continue;
        if (now > next.cost) {
          pairs.push({now, a, b, age_[a] + age_[b]});
          continue;
        }
      }
      merge(a, b);
    }
  }

  // Of each piece the number of its facet.
  std::vector<Index> numbered() { return facets_.numbered(); }

 private:
  static constexpr std::size_t stretch = 4096;

  struct Pair {
    double cost;
    Index a, b, age;
    bool operator<(const Pair& other) const {
      return std::tie(other.cost, other.a, other.b) < std::tie(cost, a, b);
    }
  };

  // The area times the mean squared distance from the plane.
  static double bend(const SurfaceMoments& moments) {
    return moments.area > 0 ? least_eigen_of(moments.scatter()).value : 0;
  }

  // Of the lesser facet, the mean squared distance that it adds.
  double cost(Index a, Index b) const {
    SurfaceMoments both = moments_[a];
    both += moments_[b];
    const double least = std::min(moments_[a].area, moments_[b].area);
    return least > 0 ? std::max(0.0, bend(both) - bend_[a] - bend_[b]) / least : 0;
  }

  void merge(Index a, Index b) {
    if (moments_[b].pieces > moments_[a].pieces) std::swap(a, b);
    facets_.join(a, b);
    moments_[a] += moments_[b];
    bend_[a] = bend(moments_[a]);
    age_[a] += age_[b] + 1;
  }

  std::vector<SurfaceMoments> moments_;
  std::vector<double> bend_;
  DisjointSets facets_;
  std::vector<Index> age_;
};

std::vector<Index> merged(const std::vector<SurfaceMoments>& pieces, const Adjacency& adjacent,
                          double deviation, const Context& context) {
  Merging merging(pieces);
  merging.run(
      adjacent, deviation * deviation, [](auto&, auto&) { return true; }, context);
  return merging.numbered();
}

// What great_facets() asks of the pieces of a mesh.
class TouchingPieces {
 public:
  TouchingPieces(PointsView points, const SurfacePieces& pieces, double slab)
      : points_(points), pieces_(pieces), slab_(slab), touching_(pieces.moments.size()) {
    for (const auto& [a, b] : pieces.adjacent) {
      touching_[a].push_back(b);
      touching_[b].push_back(a);
    }
  }

  const SurfaceMoments& moments(Index piece) const { return pieces_.moments[piece]; }
  bool is_in(const FacetPlane& plane, Index piece) const {
    const std::vector<Index>& own = pieces_.points[piece];
    return std::all_of(own.begin(), own.end(), [&](Index i) {
      return std::abs(plane.normal.dot(points_[i] - plane.centroid)) < slab_;
    });
  }
  template <typename Visit>
  void for_each_next(Index piece, const Visit& visit) const {
    for (const Index next : touching_[piece]) visit(next);
  }

 private:
  PointsView points_;
  const SurfacePieces& pieces_;
  double slab_;
  std::vector<std::vector<Index>> touching_;
};

}  // namespace

std::vector<Index> facets_of(PointsView points, const SurfacePieces& pieces, double noise,
                             const Context& context) {
  const double deviation = std::max(coordinate_rounding, flat * noise);
  std::vector<Index> facet = merged(pieces.moments, pieces.adjacent, deviation, context);
  if (noise == 0) return facet;
  facet = great_facets(TouchingPieces(points, pieces, in_plane * noise), std::move(facet), context);
  std::vector<SurfaceMoments> joined;
  std::vector<Index> number(pieces.moments.size(), -1), own(pieces.moments.size());
  for (std::size_t i = 0; i < own.size(); ++i) {
    Index fresh = static_cast<Index>(joined.size());
    Index& at = facet[i] < 0 ? fresh : number[facet[i]];
    if (at < 0) at = fresh;
    if (at == static_cast<Index>(joined.size())) joined.emplace_back();
    joined[at] += pieces.moments[i];
    own[i] = at;
  }
  Adjacency adjacent;
  for (const auto& [a, b] : pieces.adjacent)
    if (own[a] != own[b]) adjacent.emplace_back(own[a], own[b]);
  const std::vector<Index> again = merged(joined, adjacent, deviation, context);
  for (std::size_t i = 0; i < own.size(); ++i) facet[i] = again[own[i]];
  return facet;
}

double noise_of(PointsView points, const SurfacePieces& pieces, const Context& context) {
  constexpr Index full = 24;         // pieces of a patch: some 20 points, of which 6 are fitted
  constexpr std::size_t least = 12;  // points
  constexpr double flattest = 0.3;   // of the patches
  constexpr double shown = 0.75;     // of the noise, as the flattest show little of it
  Merging merging(pieces.moments);
  merging.run(
      pieces.adjacent, infinity,
      [&](const auto& a, const auto& b) { return a.pieces < full && b.pieces < full; }, context);
  std::vector<double> deviations;
  for (const std::vector<Index>& members : members_of(merging.numbered())) {
    SurfaceMoments moments;
    std::vector<Index> own;
    for (const Index piece : members) {
      moments += pieces.moments[piece];
      own.insert(own.end(), pieces.points[piece].begin(), pieces.points[piece].end());
    }
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    if (own.size() < least || !(moments.area > 0)) continue;
    const auto eigen = eigen_of(moments.scatter());
    const double size = std::sqrt(eigen.values[2] / moments.area);
    std::vector<Vector3> local;
    QuadraticFit fit;
    for (const Index i : own) {
      local.push_back(eigen.vectors.transpose() * (points[i] - moments.centroid()) / size);
      fit.add(local.back()[2], local.back()[1], local.back()[0]);
    }
    const QuadraticFit::Coefficients h = fit.coefficients();
    double sum = 0;
    for (const Vector3& x : local) {
      const double u = x[2], v = x[1];
      const double off = x[0] - h.dot(QuadraticFit::Coefficients{{1, u, v, u * u, u * v, v * v}});
      sum += off * off;
    }
    deviations.push_back(size * std::sqrt(sum / static_cast<double>(own.size() - 6)));
  }
  return deviations.empty() ? 0 : quantile(std::move(deviations), flattest) / shown;
}

namespace {

// Spacings that a point may lie off the plane of its facet without noise.
constexpr double off_plane = 0.1;

// Cosine between the normals of a facet and of a point that it grows by: 20 degrees.
constexpr double same_normal = 0.94;

constexpr Index least_points = 8;  // of a facet

// Spacings over which a facet goes on: random points leave holes.
constexpr double hole = 3;

class RegionGrowing {
 public:
  explicit RegionGrowing(CloudFacets& found)
      : found_(found),
        surface_(found.surface),
        off_(std::max(in_plane * found.noise, off_plane * surface_.spacing)) {}

  void run(const Context& context) {
    found_.facet.assign(surface_.size(), -1);
    const std::vector<Index> seeds = flattest_first(context.stage(0, 0.3));
    interruptible_for(context, static_cast<Index>(seeds.size()), [&](Index k) {
      if (found_.facet[seeds[k]] < 0) grow(seeds[k]);
    });
    found_.facet = great_facets(*this, std::move(found_.facet), context);
    fit_planes();
  }

  SurfaceMoments moments(Index i) const { return SurfaceMoments::of_point(surface_.point(i)); }
  bool is_in(const FacetPlane& plane, Index i) const {
    return std::abs(plane.normal.dot(surface_.point(i) - plane.centroid)) <= off_;
  }
  template <typename Visit>
  void for_each_next(Index i, const Visit& visit) const {
    surface_.tree.within(surface_.point(i), hole * surface_.spacing,
                         [&](std::int32_t next, double) { visit(next); });
  }

 private:
  // By how far the normals of a point and its neighbours differ.
  std::vector<Index> flattest_first(const Context& context) const {
    std::vector<double> bend(surface_.size());
    constexpr Index grain = 1024;
    parallel_for(context, surface_.size(), grain, [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i)
        for (const std::int32_t j : surface_.neighbours.row(i))
          bend[i] = std::max(bend[i], 1 - std::abs(surface_.normal(i).dot(surface_.normal(j))));
    });
    std::vector<Index> order(surface_.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return bend[a] < bend[b]; });
    return order;
  }

  void grow(Index seed) {
    const auto own = static_cast<Index>(found_.planes.size());
    SurfaceMoments sums = moments(seed);
    for (const std::int32_t j : surface_.neighbours.row(seed)) sums += moments(j);
    FacetPlane plane = plane_of(sums);
    double fitted = sums.area;
    sums = moments(seed);
    std::vector<Index> members{seed};
    found_.facet[seed] = own;
    for (std::size_t k = 0; k < members.size(); ++k)
      for (const std::int32_t j : surface_.neighbours.row(members[k])) {
        if (found_.facet[j] >= 0 || !is_in(plane, j) ||
            std::abs(plane.normal.dot(surface_.normal(j))) < same_normal)
          continue;
        found_.facet[j] = own;
        members.push_back(j);
        sums += moments(j);
        if (sums.area > refitted * fitted) {
          plane = plane_of(sums);
          fitted = sums.area;
        }
      }
    if (static_cast<Index>(members.size()) < least_points) {
      for (const Index i : members) found_.facet[i] = -1;
      return;
    }
    found_.planes.push_back(plane);
  }

  // Through the points that facets have now; without any there is none.
  void fit_planes() {
    std::vector<SurfaceMoments> sums;
    std::vector<Index> number(found_.planes.size(), -1);
    for (Index i = 0; i < surface_.size(); ++i) {
      if (found_.facet[i] < 0) continue;
      Index& own = number[found_.facet[i]];
      if (own < 0) {
        own = static_cast<Index>(sums.size());
        sums.emplace_back();
      }
      found_.facet[i] = own;
      sums[own] += moments(i);
    }
    found_.planes.clear();
    for (const SurfaceMoments& facet : sums) found_.planes.push_back(plane_of(facet));
  }

  CloudFacets& found_;
  const SurfacePoints& surface_;
  double off_;
};

}  // namespace

CloudFacets::CloudFacets(PointsView points, const Context& context)
    : rows(distinct_points(points, context.stage(0, 0.1)).first),
      surface(chosen_rows(points, rows), context.stage(0.1, 0.6)),
      noise(surface.noise) {
  RegionGrowing(*this).run(context.stage(0.6, 1));
}

double CloudFacets::squared_distance(const Vector3& x) const {
  constexpr Index around = 8;
  constexpr double near = 2;  // spacings
  std::vector<Neighbour> found;
  surface.tree.nearest(x, around, found);
  const double reach = near * surface.spacing;
  double least = infinity;
  for (const Neighbour& n : found) {
    if (n.squared_distance > reach * reach) continue;
    const Index own = facet[n.index];
    const double off = own >= 0 ? planes[own].normal.dot(x - planes[own].centroid)
                                : surface.normal(n.index).dot(x - surface.point(n.index));
    least = std::min(least, off * off);
  }
  return least;
}

}  // namespace symsurf
