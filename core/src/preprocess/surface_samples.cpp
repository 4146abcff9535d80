#include "preprocess/surface_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "mesh/triangle_mesh.h"
#include "score/matching.h"

namespace symsurf {

namespace {

// Samples on the whole surface: the legs of a chair, 7 % as thick as the seat is wide, are then
// five samples wide. No more than thrice as many where faces are so thin that their edges alone ask
// for more.
constexpr double wanted = 20000, most = 3 * wanted;

// So many vertices say enough of a surface where they lie evenly: where no edge of a face is longer
// than so many of the spacings that as many points would have on a grid. Curved surfaces, remeshed
// or made of a grid, have edges of 1.7 to 3.2 spacings (nine meshes, the longest edge of each).
constexpr Index enough = 1000;
constexpr double even = 4;

// Two edges of a face whose lengths differ by less than this share are equally long; its directions
// are at a right angle where the cosine is below that. Mirrored faces of a file in single precision
// differ by 1e-7 of the coordinates.
constexpr double equal_length = 1e-5, right_angle = 1e-3;

// An edge within this share of a whole number of spacings counts as that many.
constexpr double rounding = 1e-6;

// The sine of the angle at a flat edge, which a surface does not bend at.
constexpr double flat = 1e-3;

// The cosine of the widest angle, 102 degrees, between the directions of a lattice: its cells have
// then at least 0.85 of the area of a square.
constexpr double widest = -0.2;

Index intervals(double length, double spacing) {
  return std::max<Index>(1, static_cast<Index>(std::ceil(length / spacing - rounding)));
}

// A face with an area: its corners in an order that its shape defines, so that mirrored faces are
// filled alike.
struct Face {
  // A grid along two edges; rows along one.
  enum class Filling { Grid, Rows } filling;
  std::array<Index, 3>
      corner;            // Grid: where its edges meet, then their ends. Rows: apex, then base
  Vector3 origin, u, v;  // the first corner, and from it to the others
  Vector3 area;          // twice, as a vector along the normal
};

double angle_cosine(const Vector3& a, const Vector3& b) {
  return a.dot(b) / std::sqrt(a.squaredNorm() * b.squaredNorm());
}

bool make_face(PointsView points, const Index* corner, Face& face) {
  const std::array<Vector3, 3> x{points[corner[0]], points[corner[1]], points[corner[2]]};
  std::array<double, 3> opposite;  // the length of the edge opposite each corner
  for (int c = 0; c < 3; ++c) opposite[c] = (x[(c + 1) % 3] - x[(c + 2) % 3]).norm();
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return opposite[a] > opposite[b]; });  // longest first
  const double longest = opposite[order[0]];
  const auto are_equal = [&](int a, int b) {
    return opposite[order[a]] - opposite[order[b]] < equal_length * longest;
  };
  face.area = (x[1] - x[0]).cross(x[2] - x[0]);
  if (!(face.area.norm() > 1e-12 * longest * longest)) return false;
  const int wide = order[0];
  const double cosine = angle_cosine(x[(wide + 1) % 3] - x[wide], x[(wide + 2) % 3] - x[wide]);
  const bool equilateral = are_equal(0, 2),
             isosceles = are_equal(0, 1) && !(std::abs(cosine) < right_angle);
  const bool is_grid = equilateral || (!isosceles && cosine > widest);
  // Rows along the edge that is unlike the other two, or along the longest.
  const int first = isosceles && !equilateral ? order[2] : order[0];
  face.filling = is_grid ? Face::Filling::Grid : Face::Filling::Rows;
  for (int c = 0; c < 3; ++c) face.corner[c] = corner[(first + c) % 3];
  face.origin = x[first];
  face.u = x[(first + 1) % 3] - x[first];
  face.v = x[(first + 2) % 3] - x[first];
  return true;
}

// The points inside a face.
template <typename Visit>
void for_each_inside(const Face& face, double spacing, const Visit& visit) {
  const double u = face.u.norm(), v = face.v.norm();
  if (face.filling == Face::Filling::Grid) {
    const Index p = intervals(u, spacing), q = intervals(v, spacing);
    for (Index i = 1; i < p; ++i)
      for (Index j = 1; i * q + j * p < p * q; ++j)
        visit(face.origin + static_cast<double>(i) / static_cast<double>(p) * face.u +
              static_cast<double>(j) / static_cast<double>(q) * face.v);
    return;
  }
  const Vector3 base = face.v - face.u;
  const Index rows = intervals(face.area.norm() / base.norm(), spacing);
  for (Index row = 1; row < rows; ++row) {
    const double down = static_cast<double>(row) / static_cast<double>(rows);
    const Index n = intervals(down * base.norm(), spacing);
    for (Index k = 1; k < n; ++k)
      visit(face.origin + down * (face.u + static_cast<double>(k) / static_cast<double>(n) * base));
  }
}

// An edge of a face.
struct Edge {
  Index low, high;  // the vertices at its ends
  Index face;
  bool is_diagonal;  // of the rectangle that a grid is half of

  auto key() const { return std::tuple(low, high); }
};

// Samples faces with a spacing.
class Sampler {
 public:
  Sampler(PointsView points, TrianglesView given, double area, const Context& context)
      : points_(points), context_(context), spacing_(std::sqrt(area / wanted)) {
    interruptible_for(context, given.size(), [&](Index f) {
      const Index* corner = given[f];
      Face face;
      const auto length = [&](int a, int b) {
        return (points[corner[a]] - points[corner[b]]).norm();
      };
      if (std::max({length(0, 1), length(1, 2), length(2, 0)}) > spacing_ * (1 + rounding) &&
          make_face(points, corner, face))
        faces_.push_back(face);
    });
    if (faces_.empty()) return;
    const std::vector<Index> vertex = distinct_vertices();
    drop_duplicates(vertex);
    find_edges(vertex);
    while (count() > most) spacing_ *= 1.25;
  }

  template <typename Visit>
  void for_each(const Visit& visit) const {
    for_each_on_edges(
        [&](const Vector3& from, const Vector3& along, Index n, const Vector3& normal) {
          for (Index k = 1; k < n; ++k)
            visit(from + static_cast<double>(k) / static_cast<double>(n) * along, normal);
        });
    interruptible_for(context_, static_cast<Index>(faces_.size()), [&](Index f) {
      for_each_inside(faces_[f], spacing_,
                      [&](const Vector3& x) { visit(x, faces_[f].area.normalized()); });
    });
  }

 private:
  double count() const {
    double samples = 0;
    for_each_on_edges([&](const Vector3&, const Vector3&, Index n, const Vector3&) {
      samples += static_cast<double>(n - 1);
    });
    // Of a face without its edges, for its area; exact where it is large against the spacing.
    for (const Face& face : faces_) samples += face.area.norm() / 2 / (spacing_ * spacing_);
    return samples;
  }

  // Of equal points the lowest number: corners that no file merged are one.
  std::vector<Index> distinct_vertices() const {
    std::vector<Index> used;
    for (const Face& face : faces_) used.insert(used.end(), face.corner.begin(), face.corner.end());
    const auto key = [&](Index i) {
      const Vector3 x = points_[i];
      return std::tuple(x.x(), x.y(), x.z(), i);
    };
    std::sort(used.begin(), used.end(), [&](Index a, Index b) { return key(a) < key(b); });
    std::vector<Index> vertex(points_.size());
    for (std::size_t k = 0; k < used.size(); ++k) {
      const bool is_duplicate = k > 0 && points_[used[k]] == points_[used[k - 1]];
      vertex[used[k]] = is_duplicate ? vertex[used[k - 1]] : used[k];
    }
    return vertex;
  }

  // Faces of the same corners, as those with two sides, are one.
  void drop_duplicates(const std::vector<Index>& vertex) {
    std::vector<std::pair<std::array<Index, 3>, Index>> corners;
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      std::array<Index, 3> corner = faces_[f].corner;
      for (Index& i : corner) i = vertex[i];
      std::sort(corner.begin(), corner.end());
      corners.emplace_back(corner, static_cast<Index>(f));
    }
    std::sort(corners.begin(), corners.end());
    const auto duplicates =
        std::unique(corners.begin(), corners.end(),
                    [](const auto& a, const auto& b) { return a.first == b.first; });
    if (duplicates == corners.end()) return;
    std::vector<Index> kept;
    for (auto it = corners.begin(); it != duplicates; ++it) kept.push_back(it->second);
    std::sort(kept.begin(), kept.end());
    std::vector<Face> faces;
    for (const Index f : kept) faces.push_back(faces_[f]);
    faces_ = std::move(faces);
  }

  void find_edges(const std::vector<Index>& vertex) {
    for (Index f = 0; f < static_cast<Index>(faces_.size()); ++f)
      for (int c = 0; c < 3; ++c) {
        const auto& corner = faces_[f].corner;
        const Index a = vertex[corner[(c + 1) % 3]], b = vertex[corner[(c + 2) % 3]];
        const bool is_diagonal = c == 0 && faces_[f].filling == Face::Filling::Grid;
        edges_.push_back({std::min(a, b), std::max(a, b), f, is_diagonal});
      }
    std::stable_sort(edges_.begin(), edges_.end(),
                     [](const Edge& a, const Edge& b) { return a.key() < b.key(); });
  }

  // Every edge once, in as many intervals as its samples divide it into.
  template <typename Visit>
  void for_each_on_edges(const Visit& visit) const {
    for (std::size_t begin = 0, end; begin < edges_.size(); begin = end) {
      end = begin + 1;
      while (end < edges_.size() && edges_[end].key() == edges_[begin].key()) ++end;
      const Vector3 from = points_[edges_[begin].low], along = points_[edges_[begin].high] - from;
      const Face& face = faces_[edges_[begin].face];
      Index n = intervals(along.norm(), spacing_);
      if (divides_a_grid(begin, end))
        n = std::gcd(intervals(face.u.norm(), spacing_), intervals(face.v.norm(), spacing_));
      visit(from, along, n, face.area.normalized());
    }
  }

  // Whether an edge is a diagonal inside a flat part of the surface: the grids on its sides go on
  // across it.
  bool divides_a_grid(std::size_t begin, std::size_t end) const {
    if (end - begin != 2 || !edges_[begin].is_diagonal || !edges_[begin + 1].is_diagonal)
      return false;
    const Vector3 one = faces_[edges_[begin].face].area.normalized(),
                  other = faces_[edges_[begin + 1].face].area.normalized();
    return one.cross(other).norm() < flat;
  }

  PointsView points_;
  const Context& context_;
  double spacing_;
  std::vector<Face> faces_;
  std::vector<Edge> edges_;
};

bool are_even(PointsView vertices, TrianglesView faces, double area) {
  const Index count = vertices.size();
  return count >= enough &&
         longest_edge(vertices, faces) < even * std::sqrt(area / static_cast<double>(count));
}

Points with(PointsView rows, const std::vector<Vector3>& more) {
  Points all(rows.size() + static_cast<Index>(more.size()), 3);
  all.topRows(rows.size()) = rows.matrix();
  for (std::size_t i = 0; i < more.size(); ++i)
    all.row(rows.size() + static_cast<Index>(i)) = more[i].transpose();
  return all;
}

}  // namespace

bool SurfaceSamples::apply(Cloud& cloud, const Context& context) {
  const TrianglesView faces = cloud.faces;
  cloud.faces = {};
  const double area = surface_area(cloud.points, faces);
  if (!(area > 0) || are_even(cloud.points, faces, area)) return false;
  std::vector<Vector3> samples, normals;
  Sampler(cloud.points, faces, area, context)
      .for_each([&](const Vector3& x, const Vector3& normal) {
        samples.push_back(x);
        if (!cloud.normals.empty()) normals.push_back(normal);
      });
  if (samples.empty()) return false;
  vertices_ = cloud.points;
  diagonal_ = cloud.diagonal;
  count_ = static_cast<Index>(samples.size());
  cloud.vertices = vertices_;
  replace(cloud, with(cloud.points, samples), with(cloud.normals, normals));
  return true;
}

void SurfaceSamples::map_back(Result& result, double pair_distance, const Context& context) const {
  result.statistics["surface_samples"] = count_;
  pair_anew(result, vertices_, pair_distance * diagonal_, context);
}

}  // namespace symsurf
