#include "symmetries/recurring/facets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

#include "base/eigenvectors.h"
#include "base/least_squares.h"
#include "base/math.h"

namespace symsurf {

SurfaceMoments SurfaceMoments::of_triangle(const Vector3& a, const Vector3& b, const Vector3& c) {
  SurfaceMoments moments;
  moments.area = (b - a).cross(c - a).norm() / 2;
  const Vector3 sum = a + b + c;
  moments.sum = moments.area / 3 * sum;
  moments.products = moments.area / 12 *
                     (sum * sum.transpose() + a * a.transpose() + b * b.transpose() +
                      c * c.transpose());
  return moments;
}

SurfaceMoments& SurfaceMoments::operator+=(const SurfaceMoments& other) {
  area += other.area;
  sum += other.sum;
  products += other.products;
  return *this;
}

FacetPlane plane_of(const SurfaceMoments& moments) {
  const LeastEigen eigen = least_eigen_of(moments.scatter());
  return {moments.centroid(), eigen.vector.normalized(), std::sqrt(eigen.next / moments.area)};
}

namespace {

// Greedy merging with a heap of the pairs that touch; costs are renewed when their turn comes.
class Merging {
 public:
  explicit Merging(const std::vector<SurfaceMoments>& pieces)
      : moments_(pieces), root_(pieces.size()), count_(pieces.size(), 1), age_(pieces.size(), 0) {
    for (std::size_t i = 0; i < pieces.size(); ++i) root_[i] = static_cast<Index>(i);
    for (const SurfaceMoments& piece : pieces) bend_.push_back(bend(piece));
  }

  // Until no pair of facets, the lesser of which is of less than `most_area`, costs up to `limit`.
  void run(const Adjacency& adjacent, double limit, double most_area, Index full,
           const Context& context) {
    const auto closed = [&](Index a, Index b) {
      return a == b || count_[a] >= full || count_[b] >= full ||
             std::min(moments_[a].area, moments_[b].area) >= most_area;
    };
    std::priority_queue<Pair> pairs;
    const auto push = [&](Index a, Index b, bool is_new, double before) {
      if (closed(a, b)) return;
      const double now = cost(a, b);
      if (now <= limit && (is_new || now > before))
        pairs.push({now, a, b, age_[a] + age_[b]});
    };
    for (std::size_t begin = 0; begin < adjacent.size(); begin += stretch) {
      context.check();
      for (std::size_t k = begin; k < std::min(adjacent.size(), begin + stretch); ++k)
        push(root(adjacent[k].first), root(adjacent[k].second), true, 0);
    }
    for (std::size_t step = 0; !pairs.empty(); ++step) {
      if (step % stretch == 0) context.check();
      const Pair next = pairs.top();
      pairs.pop();
      const Index a = root(next.a), b = root(next.b);
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

  Index root(Index piece) {
    while (root_[piece] != piece) piece = root_[piece] = root_[root_[piece]];
    return piece;
  }

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
    if (count_[a] < count_[b] || (count_[a] == count_[b] && b < a)) std::swap(a, b);
    root_[b] = a;
    count_[a] += count_[b];
    moments_[a] += moments_[b];
    bend_[a] = bend(moments_[a]);
    age_[a] += age_[b] + 1;
  }

  std::vector<SurfaceMoments> moments_;
  std::vector<double> bend_;
  std::vector<Index> root_, count_, age_;
};

}  // namespace

std::vector<Index> merged_facets(const std::vector<SurfaceMoments>& pieces,
                                 const Adjacency& adjacent, double deviation, double least_area,
                                 Index full, const Context& context) {
  Merging merging(pieces);
  merging.run(adjacent, deviation * deviation, infinity, full, context);
  merging.run(adjacent, infinity, least_area, full, context);
  std::vector<Index> facet(pieces.size(), -1), number(pieces.size(), -1);
  Index count = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    Index& own = number[merging.root(static_cast<Index>(i))];
    if (own < 0) own = count++;
    facet[i] = own;
  }
  return facet;
}

double noise_of_pieces(PointsView points, const std::vector<std::vector<Index>>& corners,
                       const std::vector<SurfaceMoments>& pieces, const Adjacency& adjacent,
                       const Context& context) {
  constexpr Index full = 24;               // pieces of a patch: some 20 points, of which 6 are fitted
  constexpr std::size_t least = 12;        // points
  constexpr double flattest = 0.3;         // of the patches
  const std::vector<Index> patch = merged_facets(pieces, adjacent, infinity, 0, full, context);
  std::vector<SurfaceMoments> moments;
  std::vector<std::vector<Index>> members;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto own = static_cast<std::size_t>(patch[i]);
    if (own >= moments.size()) {
      moments.resize(own + 1);
      members.resize(own + 1);
    }
    moments[own] += pieces[i];
    members[own].insert(members[own].end(), corners[i].begin(), corners[i].end());
  }
  std::vector<double> deviations;
  for (std::size_t p = 0; p < members.size(); ++p) {
    std::vector<Index>& own = members[p];
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    if (own.size() < least || !(moments[p].area > 0)) continue;
    const auto eigen = eigen_of(moments[p].scatter());
    const double size = std::sqrt(eigen.values[2] / moments[p].area);
    std::vector<Vector3> local;
    QuadraticFit fit;
    for (const Index i : own) {
      local.push_back(eigen.vectors.transpose() * (points[i] - moments[p].centroid()) / size);
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
  return deviations.empty() ? 0 : quantile(std::move(deviations), flattest);
}

}  // namespace symsurf
