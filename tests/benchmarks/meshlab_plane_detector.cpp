// SPDX-License-Identifier: GPL-3.0-or-later
//
// The plane detector in MeshLab's own library (vcg/complex/algorithms/symmetry.h: every pair of
// points votes for its bisecting plane) against symsurf's method "plane", on the same points in one
// run. CPU seconds of one thread each, from points that are already where each wants them to the
// plane; of the quick one the mean of several runs. Errors against the known plane.

#include <symsurf/detect.h>
#include <symsurf/mirrors.h>
#include <vcg/complex/algorithms/symmetry.h>
#include <vcg/complex/complex.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <random>

#include "bumpy_object.h"

namespace {

class Vertex;
class Face;
struct Used : vcg::UsedTypes<vcg::Use<Vertex>::AsVertexType, vcg::Use<Face>::AsFaceType> {};
class Vertex : public vcg::Vertex<Used, vcg::vertex::Coord3d, vcg::vertex::Normal3d,
                                  vcg::vertex::BitFlags, vcg::vertex::Mark> {};
class Face : public vcg::Face<Used, vcg::face::VertexRef, vcg::face::Normal3d, vcg::face::FFAdj,
                              vcg::face::BitFlags, vcg::face::Mark> {};
class VcgMesh : public vcg::tri::TriMesh<std::vector<Vertex>, std::vector<Face>> {};

using symsurf::Index, symsurf::Plane, symsurf::Points, symsurf::Vector3;

// Rows 2i and 2i + 1 mirror each other in a plane close to the origin, where MeshLab's detector is
// at its best.
struct Scene {
  const char* name;
  Points points;
  Plane truth;
};

std::mt19937 generator(unsigned seed) { return std::mt19937(seed + 1000); }

Vector3 draw(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random);
  return {x, y, normal(random)};
}

Scene surface(Index size, unsigned seed) {
  std::mt19937 random = generator(seed);
  Points points = symsurf::benchmarks::bumpy_object(size, seed);
  const Vector3 normal = (points.row(0) - points.row(1)).normalized();
  const double offset = 0.2 * draw(random).x();
  points.rowwise() -= offset * normal.transpose();
  return {"on a surface", points, Plane(normal, offset)};
}

Scene volume(Index size, unsigned seed) {
  std::mt19937 random = generator(seed);
  const Vector3 normal = draw(random);
  const Plane plane(normal, 0.2 * draw(random).x());
  Points points(size, 3);
  const Vector3 along = plane.normal().unitOrthogonal();
  for (Index i = 0; i + 1 < size; i += 2) {
    Vector3 x = draw(random);
    x += 2 * x.dot(along) * along + 0.3 * std::pow(x.dot(along), 2) * plane.normal().cross(along);
    points.row(i) = x.transpose();
    points.row(i + 1) = plane.reflect(x).transpose();
  }
  return {"in a volume", points, plane};
}

// Normal noise in each coordinate, as a share of the diagonal.
void add_noise(Points& points, double share, unsigned seed) {
  std::mt19937 random = generator(seed);
  const Vector3 extent = points.colwise().maxCoeff() - points.colwise().minCoeff();
  for (Index i = 0; i < points.rows(); ++i)
    points.row(i) += share * extent.norm() * draw(random).transpose();
}

double seconds(std::clock_t start) {
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

struct Found {
  Plane plane;
  double cpu;
};

Found by_voting(const Points& points) {
  VcgMesh mesh;
  auto vertex = vcg::tri::Allocator<VcgMesh>::AddVertices(mesh, points.rows());
  for (Index i = 0; i < points.rows(); ++i, ++vertex)
    vertex->P() = vcg::Point3d(points(i, 0), points(i, 1), points(i, 2));
  vcg::tri::UpdateBounding<VcgMesh>::Box(mesh);
  const std::clock_t start = std::clock();
  vcg::tri::ExtrinsicPlaneSymmetry<VcgMesh> detector(mesh);
  detector.Init();
  std::vector<vcg::Plane3<double>> planes;
  detector.GetPlanes(planes, 1);
  const double cpu = seconds(start);
  const vcg::Point3d n = planes[0].Direction();
  return {Plane({n[0], n[1], n[2]}, -planes[0].Offset()), cpu};
}

Found by_symsurf(const Points& points) {
  symsurf::Options options;
  options.method = "plane";
  options.parameters = {{"max_candidates", Index{0}}};  // the best plane alone, as above
  constexpr int runs = 20;
  symsurf::Result result;
  const std::clock_t start = std::clock();
  for (int run = 0; run < runs; ++run)
    result = symsurf::detect(points, options, symsurf::Context({}, 1));
  const double cpu = seconds(start) / runs;
  return {dynamic_cast<const Plane&>(*result.mirror), cpu};
}

void report(const char* name, const Found& found, const Plane& truth) {
  const double cosine = found.plane.normal().dot(truth.normal());
  const double sine = found.plane.normal().cross(truth.normal()).norm();
  const double offset = found.plane.offset() - (cosine < 0 ? -1 : 1) * truth.offset();
  std::printf("  %-8s %9.4f s  normal off by %9.2e degrees, offset by %9.2e\n", name, found.cpu,
              std::atan2(sine, std::abs(cosine)) * 180 / M_PI, std::abs(offset));
}

}  // namespace

int main() {
  for (const auto make : {surface, volume})
    for (const double noise : {0.0, 0.001, 0.01})
      for (unsigned seed = 0; seed < 3; ++seed) {
        Scene scene = make(2000, seed);
        add_noise(scene.points, noise, seed);
        const Found voted = by_voting(scene.points), ours = by_symsurf(scene.points);
        std::printf("2000 points %s, seed %u, noise %g of the diagonal: %.0f times faster\n",
                    scene.name, seed, noise, voted.cpu / ours.cpu);
        report("MeshLab", voted, scene.truth);
        report("symsurf", ours, scene.truth);
      }
}
