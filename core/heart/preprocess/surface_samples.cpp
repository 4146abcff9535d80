#include "preprocess/surface_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/math.h"
#include "base/parallel.h"
#include "cloud/exact_isometries.h"
#include "cloud/voxel_grid.h"
#include "pairing/matching.h"
#include "score/verdict.h"

namespace symsurf {

namespace {

// The legs of a chair, 7 % as thick as the seat is wide, are then five samples wide.
constexpr Index wanted = 20000;

// So many vertices say enough of a surface where they lie evenly: where the squares of the faces'
// longest edges, averaged over the area, are at most so many times the area a vertex. It is 1.2
// for equilateral faces, 2 for a grid, 3.6 where half of a grid is five times as dense.
constexpr Index enough = 1000;
constexpr double even = 3;

// The Kronecker sequence of three dimensions (Roberts 2018): powers of 1 / g, g^4 = g + 1.
constexpr std::array<double, 3> steps{0.8191725133961645, 0.6710436067037893, 0.5497004779019703};

double low_discrepancy(Index k, int dimension) {
  const double x = static_cast<double>(k) * steps[dimension];
  return x - std::floor(x);
}

struct Face {
  Vector3 origin, u, v;  // a corner, and from it to the others
  Vector3 normal;        // as long as twice the area
  double area() const { return normal.norm() / 2; }
};

// Those with an area; of faces with the same three corners, as those with two sides, the first.
std::vector<Face> distinct_faces(PointsView points, TrianglesView given, const Context& context) {
  TripleIndex positions, corners;
  std::vector<Face> faces;
  interruptible_for(context, given.size(), [&](Index f) {
    const Index* corner = given[f];
    Triple triple;
    for (int c = 0; c < 3; ++c) triple[c] = positions.add(ordered_bits(points[corner[c]]));
    std::sort(triple.begin(), triple.end());
    const Index known = corners.size();
    if (corners.add(triple) < known) return;
    const Vector3 x = points[corner[0]], u = points[corner[1]] - x, v = points[corner[2]] - x;
    faces.push_back({x, u, v, u.cross(v)});
  });
  return faces;
}

double area_of(const std::vector<Face>& faces) {
  double area = 0;
  for (const Face& face : faces) area += face.area();
  return area;
}

bool are_even(Index vertices, const std::vector<Face>& faces, double area) {
  double moment = 0;
  for (const Face& face : faces)
    moment += face.area() * std::max({face.u.squaredNorm(), face.v.squaredNorm(),
                                      (face.u - face.v).squaredNorm()});
  return vertices >= enough && moment * static_cast<double>(vertices) < even * area * area;
}

struct Samples {
  Points points, normals;  // no normals where none are wanted
};

Samples even_samples(const std::vector<Face>& faces, bool with_normals) {
  std::vector<double> areas;
  for (const Face& face : faces) areas.push_back(face.area());
  const std::vector<FaceSample> chosen = even_face_samples(areas, wanted);
  const auto count = static_cast<Index>(chosen.size());
  Samples samples{Points(count, 3), Points(with_normals ? count : 0, 3)};
  for (Index k = 0; k < count; ++k) {
    const auto& [f, down, along] = chosen[k];
    const Face& face = faces[f];
    samples.points.row(k) =
        (face.origin + down * ((1 - along) * face.u + along * face.v)).transpose();
    if (with_normals) samples.normals.row(k) = face.normal.normalized().transpose();
  }
  return samples;
}

// Those on one side of a plane, their images, and what lies on it.
Samples mirrored(const Samples& samples, const Plane& plane, double rounding) {
  std::vector<Index> kept, moved;
  for (Index i = 0; i < samples.points.rows(); ++i) {
    const double distance = plane.signed_distance(samples.points.row(i).transpose());
    if (distance > -rounding) kept.push_back(i);
    if (distance > rounding) moved.push_back(i);
  }
  const auto with_images = [&](const Points& rows, const auto& image) {
    const Points one = chosen_rows(rows, kept), other = chosen_rows(rows, moved);
    Points both(one.rows() + other.rows(), 3);
    both << one, image(other);
    return both;
  };
  return {with_images(samples.points, [&](const Points& rows) { return plane.reflect(rows); }),
          with_images(samples.normals, [&](const Points& rows) -> Points {
            return rows - 2 * (rows * plane.normal()) * plane.normal().transpose();
          })};
}

// Planes that map the mesh onto itself, orthogonal to one another: then their reflections commute,
// and samples that are mirrored over each in turn stay so over all.
std::vector<Plane> orthogonal_planes(const std::vector<Plane>& planes, const MeshSymmetry& maps,
                                     PointsView samples) {
  constexpr double orthogonal = 1e-4;  // cosine; of a prism of 1000 sides others have 3e-3
  std::vector<Plane> chosen;
  for (const Plane& plane : planes) {
    const auto is_orthogonal = [&](const Plane& other) {
      return std::abs(plane.normal().dot(other.normal())) < orthogonal;
    };
    if (std::all_of(chosen.begin(), chosen.end(), is_orthogonal) && maps(plane, samples))
      chosen.push_back(plane);
  }
  return chosen;
}

}  // namespace

// One at random within each equal share of the area: shares of as many faces would always pick the
// same.
std::vector<FaceSample> even_face_samples(const std::vector<double>& areas, Index count) {
  const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
  std::vector<FaceSample> samples;
  Index k = 0;
  double covered = 0;
  for (std::size_t f = 0; f < areas.size(); ++f) {
    covered += areas[f];
    const auto position = [&] {
      return (static_cast<double>(k) + low_discrepancy(k, 0)) / static_cast<double>(count) * area;
    };
    for (; k < count && position() < covered; ++k)
      samples.push_back(
          {static_cast<Index>(f), std::sqrt(low_discrepancy(k, 1)), low_discrepancy(k, 2)});
  }
  return samples;
}

bool SurfaceSamples::apply(Cloud& cloud, const Context& context) {
  const std::vector<Face> faces = distinct_faces(cloud.points, cloud.faces, context);
  const double area = area_of(faces);
  if (!(area > 0) || are_even(cloud.points.size(), faces, area)) {
    cloud.faces = {};
    return false;
  }
  Samples samples = even_samples(faces, !cloud.normals.empty());
  cloud.vertices = vertices_ = std::make_shared<const Cloud>(cloud);
  cloud.vertex_planes = exact_planes(*vertices_, context);
  if (!cloud.vertex_planes.empty()) {
    const MeshSymmetry maps(*vertices_, context);
    for (const Plane& plane : orthogonal_planes(cloud.vertex_planes, maps, samples.points))
      samples = mirrored(samples, plane, single_rounding * cloud.diagonal);
  }
  count_ = samples.points.rows();
  if (cloud.footprint.empty()) cloud.footprint = vertices_->points;
  replace(cloud, std::move(samples.points), std::move(samples.normals));
  return true;
}

void SurfaceSamples::map_back(Result& result, PairDistance pair_distance,
                              const Context& context) const {
  result.statistics["surface_samples"] = count_;
  if (pair_distance) pair_anew(result, *vertices_, *pair_distance * vertices_->diagonal, context);
}

}  // namespace symsurf
