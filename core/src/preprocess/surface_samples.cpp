#include "preprocess/surface_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "score/matching.h"
#include "spatial/triple_index.h"

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

}  // namespace

bool SurfaceSamples::apply(Cloud& cloud, const Context& context) {
  const std::vector<Face> faces = distinct_faces(cloud.points, cloud.faces, context);
  const double area = area_of(faces);
  if (!(area > 0) || are_even(cloud.points.size(), faces, area)) {
    cloud.faces = {};
    return false;
  }
  Points samples(wanted, 3), normals(cloud.normals.empty() ? 0 : wanted, 3);
  Index k = 0;
  double covered = 0;
  for (const Face& face : faces) {
    covered += face.area();
    // At random within its share of the area: shares of as many faces would always pick the same.
    const auto position = [&] {
      return (static_cast<double>(k) + low_discrepancy(k, 0)) / static_cast<double>(wanted) * area;
    };
    for (; k < wanted && position() < covered; ++k) {
      const double down = std::sqrt(low_discrepancy(k, 1)), along = low_discrepancy(k, 2);
      samples.row(k) = (face.origin + down * ((1 - along) * face.u + along * face.v)).transpose();
      if (normals.rows() > 0) normals.row(k) = face.normal.normalized().transpose();
    }
  }
  samples.conservativeResize(k, 3);
  normals.conservativeResize(std::min(k, normals.rows()), 3);
  vertices_ = cloud.points;
  diagonal_ = cloud.diagonal;
  count_ = k;
  cloud.vertices = vertices_;
  if (cloud.footprint.empty()) cloud.footprint = vertices_;
  replace(cloud, std::move(samples), std::move(normals));
  return true;
}

void SurfaceSamples::map_back(Result& result, double pair_distance, const Context& context) const {
  result.statistics["surface_samples"] = count_;
  pair_anew(result, vertices_, pair_distance * diagonal_, context);
}

}  // namespace symsurf
