#include "cloud/closest_point_on_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"

namespace symsurf {

namespace {

// The closest point of a triangle, by the weights of its corners. All candidates lie on it: that of
// the inside, as far as rounding leaves one, and those of the three edges.
void try_triangle(const std::array<Vector3, 3>& x, const Vector3& query, Index face,
                  ClosestPoint& best) {
  const auto offer = [&](const Vector3& weights) {
    const Vector3 point = weights[0] * x[0] + weights[1] * x[1] + weights[2] * x[2];
    const double squared = (query - point).squaredNorm();
    if (squared < best.squared_distance ||
        (squared == best.squared_distance && (best.face < 0 || face < best.face)))
      best = {face, point, weights, squared};
  };
  std::array<double, 3> lengths;  // squared, of the edges from each corner on
  for (int c = 0; c < 3; ++c) lengths[c] = (x[(c + 1) % 3] - x[c]).squaredNorm();
  const int a =
      static_cast<int>(std::max_element(lengths.begin(), lengths.end()) - lengths.begin());
  const int b = (a + 1) % 3, apex = (a + 2) % 3;
  // Along the longest edge and across: rounding then moves the point by no more than its own, even
  // where the triangle is a needle.
  const Vector3 base = x[b] - x[a], side = x[apex] - x[a], from = query - x[a];
  const double foot = side.dot(base) / lengths[a], along = from.dot(base) / lengths[a];
  const Vector3 height = side - foot * base;
  const double squared_height = height.squaredNorm();
  constexpr double needle = 1e-10;  // of the squares of height and base
  if (squared_height > 0) {
    Vector3 weights;
    weights[apex] = (from - along * base).dot(height) / squared_height;
    weights[b] = along - weights[apex] * foot;
    weights[a] = 1 - weights[b] - weights[apex];
    if (weights.minCoeff() >= 0) offer(weights);
    if (weights.minCoeff() > 0 && squared_height > needle * lengths[a]) return;
  }
  for (int c = 0; c < 3; ++c) {
    const int next = (c + 1) % 3;
    const Vector3 edge = x[next] - x[c];
    const double t = lengths[c] > 0 ? std::clamp(edge.dot(query - x[c]) / lengths[c], 0.0, 1.0) : 0;
    Vector3 weights = Vector3::Zero();
    weights[c] = 1 - t;
    weights[next] = t;
    offer(weights);
  }
}

double squared_distance(const Eigen::AlignedBox3d& box, const Vector3& query) {
  return (box.min() - query).cwiseMax(query - box.max()).cwiseMax(0).squaredNorm();
}

}  // namespace

ClosestPointOnMesh::ClosestPointOnMesh(PointsView points, TrianglesView faces,
                                       const Context& context,
                                       const std::function<bool(Index)>& uses) {
  Eigen::AlignedBox3d box;
  std::vector<Centroid> centroids;
  centroids.reserve(faces.size());
  interruptible_for(context, faces.size(), [&](Index f) {
    const Vector3 a = points[faces[f][0]], b = points[faces[f][1]], c = points[faces[f][2]];
    if (!a.allFinite() || !b.allFinite() || !c.allFinite() || (uses && !uses(f))) return;
    box.extend(a).extend(b).extend(c);
    centroids.push_back({(a + b + c) / 3, f});
  });
  if (box.isEmpty()) return;
  origin_ = box.center();
  rounding_ = 1e-14 * box.diagonal().norm();
  triangles_.reserve(centroids.size());
  build({points, faces, centroids, context}, 0, static_cast<std::int32_t>(centroids.size()));
}

// Leaves are made from the first to the last: their triangles are stored in this order.
std::int32_t ClosestPointOnMesh::build(const Building& of, std::int32_t begin, std::int32_t end) {
  constexpr std::int32_t leaf = 4, unchecked = 1 << 14;  // triangles
  if (end - begin > unchecked) of.context.check();
  const auto at = static_cast<std::int32_t>(nodes_.size());
  nodes_.push_back({{}, begin, end});
  Eigen::AlignedBox3d box;
  if (end - begin <= leaf) {
    for (std::int32_t t = begin; t < end; ++t) {
      const Index face = of.centroids[t].face;
      Triangle& triangle = triangles_.emplace_back();
      triangle.face = face;
      for (int c = 0; c < 3; ++c) {
        triangle.corner[c] = of.points[of.faces[face][c]] - origin_;
        box.extend(triangle.corner[c]);
      }
    }
  } else {
    Eigen::AlignedBox3d extent;
    for (std::int32_t t = begin; t < end; ++t) extent.extend(of.centroids[t].place);
    Index axis;
    extent.sizes().maxCoeff(&axis);
    const std::int32_t middle = begin + (end - begin) / 2;
    const auto first = of.centroids.begin();
    std::nth_element(first + begin, first + middle, first + end,
                     [axis](const Centroid& a, const Centroid& b) {
                       return std::pair(a.place[axis], a.face) < std::pair(b.place[axis], b.face);
                     });
    build(of, begin, middle);  // the next node
    const std::int32_t second = build(of, middle, end);
    nodes_[at].second = second;
    for (const std::int32_t child : {at + 1, second}) box.extend(nodes_[child].box);
  }
  nodes_[at].box = box;
  return at;
}

struct ClosestPointOnMesh::Search {
  const ClosestPointOnMesh& mesh;
  Vector3 query;
  Vector3 direction = Vector3::Zero();  // that faces are to face; zero: any
  double cosine = 0;
  ClosestPoint best = {};

  bool allows(const Triangle& t) const {
    if (direction.isZero(0)) return true;
    const Vector3 normal = (t.corner[1] - t.corner[0]).cross(t.corner[2] - t.corner[0]);
    return normal.dot(direction) >= cosine * normal.norm();
  }

  // A third of the work of try_triangle(), and most triangles of a leaf are farther.
  double squared_distance_of_box(const Triangle& t) const {
    const auto& [a, b, c] = t.corner;
    return squared_distance({a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)}, query);
  }

  // Boxes as far as the best are entered: a lower face may be as close there.
  bool may_hold(double squared) const {
    const double distance = std::sqrt(best.squared_distance) + mesh.rounding_;
    return squared <= distance * distance * (1 + 1e-14);
  }

  void visit(std::int32_t at) {
    const Node& node = mesh.nodes_[at];
    if (node.second < 0) {
      for (std::int32_t t = node.begin; t < node.end; ++t)
        if (may_hold(squared_distance_of_box(mesh.triangles_[t])) && allows(mesh.triangles_[t]))
          try_triangle(mesh.triangles_[t].corner, query, mesh.triangles_[t].face, best);
      return;
    }
    std::pair near(squared_distance(mesh.nodes_[at + 1].box, query), at + 1);
    std::pair far(squared_distance(mesh.nodes_[node.second].box, query), node.second);
    if (far < near) std::swap(near, far);
    if (may_hold(near.first)) visit(near.second);
    if (may_hold(far.first)) visit(far.second);
  }
};

ClosestPoint ClosestPointOnMesh::found(Search search, double limit) const {
  if (nodes_.empty() || !search.query.allFinite()) return {};
  search.best.squared_distance = limit;
  search.visit(0);
  if (search.best.face < 0) return {};
  search.best.point += origin_;
  return search.best;
}

ClosestPoint ClosestPointOnMesh::operator()(const Vector3& query, double limit) const {
  return found({.mesh = *this, .query = query - origin_}, limit);
}

ClosestPoint ClosestPointOnMesh::facing(const Vector3& query, const Vector3& direction,
                                        double cosine, double limit) const {
  return found({.mesh = *this, .query = query - origin_, .direction = direction, .cosine = cosine},
               limit);
}

}  // namespace symsurf
