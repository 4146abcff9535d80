#include "isotropic_remeshing.h"

#include <Eigen/Geometry>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <queue>
#include <string>
#include <utility>

#include "base/math.h"
#include "cloud/closest_point_on_mesh.h"
#include "cloud/triangle_mesh.h"

namespace symsurf {

namespace {

constexpr int rounds = 6;  // Botsch and Kobbelt: five to ten

// Of the edge length, where an edge is split and collapsed (Botsch and Kobbelt 2004).
constexpr double longest = 4.0 / 3, shortest = 4.0 / 5;

// Of the longest edge of its faces, how far the point on the surface may lie from its middle. All
// edges that splitting it leaves are then shorter: those to the third corners have 0.87 of its
// length from the middle. Beside a gap of a curve and between layers splits would not end.
constexpr double farthest = 0.125;

// A face must not turn by more than 78 degrees in one step, so that none is turned over.
constexpr double least_cosine = 0.2;

class Remesher {
 public:
  Remesher(PointsView points, const Triangles& faces, const Remeshing& remeshing,
           const Context& context)
      : remeshing_(remeshing) {
    mesh_.request_vertex_status();
    mesh_.request_edge_status();
    mesh_.request_halfedge_status();
    mesh_.request_face_status();
    for (Index i = 0; i < points.size(); ++i)
      mesh_.add_vertex({points[i].x(), points[i].y(), points[i].z()});
    for (const auto& face : faces.rowwise())
      mesh_.add_face(vertex(face[0]), vertex(face[1]), vertex(face[2]));
    if (!remeshing.keeps_boundary) mesh_.delete_isolated_vertices();
    curve_.resize(mesh_.n_edges(), none);
    freedom_.resize(mesh_.n_vertices(), free);
    find_curves();
    if (!remeshing.onto) surface_.emplace(points, faces, context);
  }

  void run(const Context& context) {
    for (int round = 0; round < rounds; ++round) {
      const Context stage = context.stage(static_cast<double>(round) / rounds,
                                          static_cast<double>(round + 1) / rounds);
      stage.report(0);
      split_long_edges(stage);
      collapse_short_edges(stage);
      flip_edges(stage);
      relax(stage);
    }
    split_chords();
  }

  Remeshed remeshed() {
    std::vector<Index> number(mesh_.n_vertices(), -1);
    std::vector<Vector3> points;
    Remeshed made;
    for (const auto v : mesh_.vertices()) {
      number[v.idx()] = static_cast<Index>(points.size());
      points.push_back(at(v));
      made.marked.push_back(is_marked(v));
    }
    std::vector<std::array<Index, 3>> faces;
    for (const auto f : mesh_.faces()) {
      auto corner = f.vertices().begin();
      const Index a = number[(*corner).idx()], b = number[(*++corner).idx()];
      faces.push_back({a, b, number[(*++corner).idx()]});
    }
    made.points = rows_of(points);
    made.faces = rows_of(faces);
    return made;
  }

 private:
  using Mesh = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;
  using Vertex = OpenMesh::VertexHandle;
  using Edge = OpenMesh::EdgeHandle;
  using Halfedge = OpenMesh::HalfedgeHandle;
  enum Curve : char { none, feature, marked };
  enum Freedom : char { free, on_curve, fixed };

  static Vertex vertex(Index i) { return Vertex(static_cast<int>(i)); }
  Vector3 at(Vertex v) const { return Vector3(mesh_.point(v).data()); }
  void set(Vertex v, const Vector3& x) { mesh_.set_point(v, {x.x(), x.y(), x.z()}); }

  double length(Edge e) const {
    const Halfedge h = mesh_.halfedge_handle(e, 0);
    return (at(mesh_.to_vertex_handle(h)) - at(mesh_.from_vertex_handle(h))).norm();
  }

  Vector3 normal(const Vector3& a, const Vector3& b, const Vector3& c) const {
    return (b - a).cross(c - a).stableNormalized();
  }

  Vector3 normal(OpenMesh::FaceHandle f) const {
    const Halfedge h = mesh_.halfedge_handle(f);
    return normal(at(mesh_.from_vertex_handle(h)), at(mesh_.to_vertex_handle(h)),
                  at(mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h))));
  }

  Edge edge_between(Vertex a, Vertex b) const {
    const Halfedge h = mesh_.find_halfedge(a, b);
    return h.is_valid() ? mesh_.edge_handle(h) : Edge();
  }

  void find_curves() {
    const double cosine = std::cos(remeshing_.feature_angle * std::numbers::pi / 180);
    for (const auto e : mesh_.edges()) {
      if (!e.is_boundary() && !(normal(e.h0().face()).dot(normal(e.h1().face())) < cosine))
        continue;
      curve_[e.idx()] = feature;
    }
    for (const auto& [a, b] : remeshing_.marked)
      if (const Edge e = edge_between(vertex(a), vertex(b)); e.is_valid()) curve_[e.idx()] = marked;
    std::vector<Vector3> ends;
    std::vector<std::array<Index, 3>> segments;
    for (const auto e : mesh_.edges()) {
      if (curve_[e.idx()] == none) continue;
      const auto first = static_cast<Index>(ends.size());
      ends.push_back(at(e.v0()));
      ends.push_back(at(e.v1()));
      segments.push_back({first, first + 1, first + 1});
    }
    if (!segments.empty()) curves_.emplace(rows_of(ends), rows_of(segments));
    for (const auto v : mesh_.vertices()) {
      std::vector<Vector3> ways;
      bool is_one = true;
      Curve kind = none;
      for (const auto e : v.edges()) {
        const Curve own = curve_[e.idx()];
        if (own == none) continue;
        is_one = is_one && (kind == none || kind == own);
        kind = own;
        ways.push_back((at(e.v0() == v ? e.v1() : e.v0()) - at(v)).stableNormalized());
      }
      const bool is_smooth = is_one && ways.size() == 2 && -ways[0].dot(ways[1]) >= cosine;
      if (!ways.empty()) freedom_[v.idx()] = is_smooth ? on_curve : fixed;
      if (remeshing_.keeps_boundary && v.is_boundary()) freedom_[v.idx()] = fixed;
    }
  }

  bool is_marked(Vertex v) const {
    const auto edges = mesh_.ve_range(v);
    return std::any_of(edges.begin(), edges.end(),
                       [&](const auto& e) { return curve_[e.idx()] == marked; });
  }

  bool is_kept(Edge e) const { return remeshing_.keeps_boundary && mesh_.is_boundary(e); }

  bool is_beside_longer(Edge e) const {
    const double own = length(e);
    for (int side = 0; side < 2; ++side) {
      const Halfedge h = mesh_.halfedge_handle(e, side);
      if (mesh_.is_boundary(h)) continue;
      for (const Halfedge other : {mesh_.next_halfedge_handle(h), mesh_.prev_halfedge_handle(h)})
        if (length(mesh_.edge_handle(other)) > own) return true;
    }
    return false;
  }

  Vector3 onto_surface(const Vector3& x) const {
    return remeshing_.onto ? remeshing_.onto(x) : (*surface_)(x).point;
  }

  // The longest first (Rivara 1984): others would make needles without end. A longer one beside is
  // then one that is kept, or stands beside such a one.
  void split_long_edges(const Context& context) {
    const double limit = longest * remeshing_.edge_length;
    std::priority_queue<std::pair<double, int>> edges;
    const auto offer = [&](Edge e) {
      const double own = length(e);
      if (own > limit && !is_kept(e)) edges.emplace(own, e.idx());
    };
    for (const auto e : mesh_.edges()) offer(e);
    for (std::size_t step = 0; !edges.empty(); ++step) {
      if (step % 4096 == 0) context.check();
      const auto [own, number] = edges.top();
      edges.pop();
      const Edge e(number);
      if (length(e) != own || is_beside_longer(e)) continue;
      for (const auto made : mesh_.ve_range(split(e))) offer(made);
    }
  }

  Vertex split(Edge e) {
    const Halfedge h = mesh_.halfedge_handle(e, 0);
    const Vertex a = mesh_.from_vertex_handle(h), b = mesh_.to_vertex_handle(h);
    const Curve curve = curve_[e.idx()];
    const Vector3 half_way = (at(a) + at(b)) / 2;
    const Vector3 on = curve == none ? onto_surface(half_way) : (*curves_)(half_way).point;
    const Vector3 middle = (on - half_way).norm() < farthest * length(e) ? on : half_way;
    const Vertex v = mesh_.add_vertex({middle.x(), middle.y(), middle.z()});
    mesh_.split(e, v);
    freedom_.push_back(curve == none ? free : on_curve);
    curve_.resize(mesh_.n_edges(), none);
    curve_[e.idx()] = none;
    for (const Vertex end : {a, b}) curve_[edge_between(v, end).idx()] = curve;
    return v;
  }

  // Edges from one point of the marked curves to another that are none of them.
  void split_chords() {
    for (int i = 0, count = static_cast<int>(mesh_.n_edges()); i < count; ++i) {
      const Edge e(i);
      if (mesh_.status(e).deleted() || curve_[i] == marked) continue;
      const Halfedge h = mesh_.halfedge_handle(e, 0);
      if (is_marked(mesh_.from_vertex_handle(h)) && is_marked(mesh_.to_vertex_handle(h))) split(e);
    }
  }

  bool may_collapse(Halfedge h) const {
    const Vertex from = mesh_.from_vertex_handle(h), to = mesh_.to_vertex_handle(h);
    const Edge e = mesh_.edge_handle(h);
    const Freedom freedom = freedom_[from.idx()];
    if (freedom == fixed || (freedom == on_curve && curve_[e.idx()] == none)) return false;
    const double limit = longest * remeshing_.edge_length;
    const Vector3 x = at(to);
    for (const Vertex w : mesh_.vv_range(from))
      if (w != to && (at(w) - x).norm() > limit) return false;
    for (const auto f : mesh_.vf_range(from)) {
      std::array<Vector3, 3> corner;
      bool goes = false;
      int k = 0;
      for (const Vertex w : mesh_.fv_range(f)) {
        goes = goes || w == to;
        corner[k++] = w == from ? x : at(w);
      }
      if (!goes && !(normal(corner[0], corner[1], corner[2]).dot(normal(f)) > least_cosine))
        return false;
    }
    Mesh& mesh = const_cast<Mesh&>(mesh_);  // it keeps marks in its vertices
    return mesh.is_collapse_ok(h);
  }

  void collapse(Halfedge h) {
    const Vertex from = mesh_.from_vertex_handle(h), to = mesh_.to_vertex_handle(h);
    std::vector<std::pair<Vertex, Curve>> curves;  // that end at the vertex which stays
    for (const Vertex v : {from, to})
      for (const auto e : mesh_.ve_range(v)) {
        const Vertex other = e.v0() == v ? e.v1() : e.v0();
        if (other != from && other != to && curve_[e.idx()] != none)
          curves.emplace_back(other, curve_[e.idx()]);
      }
    mesh_.collapse(h);
    for (const auto e : mesh_.ve_range(to)) curve_[e.idx()] = none;
    for (const auto& [other, curve] : curves) curve_[edge_between(to, other).idx()] = curve;
  }

  void collapse_short_edges(const Context& context) {
    const double limit = shortest * remeshing_.edge_length;
    for (std::size_t i = 0; i < mesh_.n_edges(); ++i) {
      if (i % 4096 == 0) context.check();
      const Edge e(static_cast<int>(i));
      if (mesh_.status(e).deleted() || is_kept(e) || length(e) >= limit) continue;
      for (int side = 0; side < 2; ++side)
        if (const Halfedge h = mesh_.halfedge_handle(e, side); may_collapse(h)) {
          collapse(h);
          break;
        }
    }
  }

  // How far the number of neighbours is from that of a regular mesh.
  int irregularity(Vertex v, int change) const {
    const int regular = mesh_.is_boundary(v) ? 4 : 6;
    const int off = static_cast<int>(mesh_.valence(v)) + change - regular;
    return off * off;
  }

  void flip_edges(const Context& context) {
    for (std::size_t i = 0; i < mesh_.n_edges(); ++i) {
      if (i % 4096 == 0) context.check();
      const Edge e(static_cast<int>(i));
      if (mesh_.status(e).deleted() || curve_[i] != none || !mesh_.is_flip_ok(e)) continue;
      const Halfedge h = mesh_.halfedge_handle(e, 0), g = mesh_.halfedge_handle(e, 1);
      const Vertex a = mesh_.from_vertex_handle(h), b = mesh_.to_vertex_handle(h);
      const Vertex c = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h));
      const Vertex d = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(g));
      const int before =
          irregularity(a, 0) + irregularity(b, 0) + irregularity(c, 0) + irregularity(d, 0);
      const int after =
          irregularity(a, -1) + irregularity(b, -1) + irregularity(c, 1) + irregularity(d, 1);
      if (after >= before) continue;
      const Vector3 mean = normal(mesh_.face_handle(h)) + normal(mesh_.face_handle(g));
      const Vector3 one = normal(at(c), at(a), at(d)), other = normal(at(d), at(b), at(c));
      if (one.dot(mean) > least_cosine && other.dot(mean) > least_cosine) mesh_.flip(e);
    }
  }

  // Vertices to the mean of their neighbours along the surface or the curve.
  void relax(const Context& context) {
    for (std::size_t i = 0; i < mesh_.n_vertices(); ++i) {
      if (i % 4096 == 0) context.check();
      const Vertex v = vertex(static_cast<Index>(i));
      if (mesh_.status(v).deleted() || freedom_[i] == fixed) continue;
      const Vector3 x = at(v);
      Vector3 sum = Vector3::Zero(), around = Vector3::Zero();
      double count = 0;
      for (const auto e : mesh_.ve_range(v)) {
        if (freedom_[i] == on_curve && curve_[e.idx()] == none) continue;
        sum += at(e.v0() == v ? e.v1() : e.v0());
        ++count;
      }
      if (count == 0) continue;
      for (const auto f : mesh_.vf_range(v)) around += normal(f);
      around.stableNormalize();
      const Vector3 step = sum / count - x;
      const Vector3 moved = freedom_[i] == on_curve
                                ? (*curves_)(Vector3(x + step)).point
                                : onto_surface(x + step - step.dot(around) * around);
      if (moved.allFinite() && keeps_faces(v, moved)) set(v, moved);
    }
  }

  // Whether no face around a vertex turns over when it moves.
  bool keeps_faces(Vertex v, const Vector3& moved) const {
    for (const auto f : mesh_.vf_range(v)) {
      std::array<Vector3, 3> corner;
      int k = 0;
      for (const Vertex w : mesh_.fv_range(f)) corner[k++] = w == v ? moved : at(w);
      const Vector3 before = normal(f);
      if (!before.isZero(0) &&
          !(normal(corner[0], corner[1], corner[2]).dot(before) > least_cosine))
        return false;
    }
    return true;
  }

  const Remeshing& remeshing_;
  Mesh mesh_;
  std::vector<Curve> curve_;      // one an edge
  std::vector<Freedom> freedom_;  // one a vertex
  std::optional<ClosestPointOnMesh> surface_, curves_;
};

}  // namespace

Remeshed isotropic_remeshing(PointsView points, TrianglesView faces, const Remeshing& remeshing,
                             const Context& context) {
  const TriangleMesh mesh(points, faces, context.stage(0, 0.1));
  if (const Index refused = mesh.refused().nonmanifold; refused > 0)
    throw InvalidInput(std::to_string(refused) + " of the " + std::to_string(faces.size()) +
                       " faces are the third at an edge or wound against their neighbours; remesh "
                       "needs a manifold, consistently oriented surface");
  Remesher remesher(points, mesh.manifold_faces(), remeshing, context);
  remesher.run(context.stage(0.1, 1));
  return remesher.remeshed();
}

}  // namespace symsurf
