// SPDX-License-Identifier: GPL-3.0-or-later
//
// The plane detector in MeshLab's own library (vcg/complex/algorithms/symmetry.h: every pair of
// points votes for its bisecting plane) against symsurf's method "plane", on the same points in one
// run. CPU seconds of one thread each; errors against the known plane.

#include <symsurf/detect.h>
#include <symsurf/plane.h>
#include <vcg/complex/algorithms/symmetry.h>
#include <vcg/complex/complex.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <random>

namespace {

class Vertex;
class Face;
struct Used : vcg::UsedTypes<vcg::Use<Vertex>::AsVertexType, vcg::Use<Face>::AsFaceType> {};
class Vertex : public vcg::Vertex<Used, vcg::vertex::Coord3d, vcg::vertex::Normal3d,
                                  vcg::vertex::BitFlags, vcg::vertex::Mark> {};
class Face : public vcg::Face<Used, vcg::face::VertexRef, vcg::face::Normal3d, vcg::face::FFAdj,
                              vcg::face::BitFlags, vcg::face::Mark> {};
class VcgMesh : public vcg::tri::TriMesh<std::vector<Vertex>, std::vector<Face>> {};

// A lump mirrored in a plane close to the origin, where MeshLab's detector is at its best.
struct Scene {
  symsurf::Points points;
  symsurf::Plane truth;
};

Scene scene(int size, unsigned seed, double noise) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto draw = [&] {
    return symsurf::Vector3(normal(random), normal(random), normal(random));
  };
  const symsurf::Plane plane(draw(), 0.2 * normal(random));
  symsurf::Points points(size, 3);
  const symsurf::Vector3 along = plane.normal().unitOrthogonal();
  for (int i = 0; i + 1 < size; i += 2) {
    symsurf::Vector3 x = draw();
    x += 2 * x.dot(along) * along + 0.3 * std::pow(x.dot(along), 2) * plane.normal().cross(along);
    points.row(i) = (x + noise * draw()).transpose();
    points.row(i + 1) = (plane.reflect(x) + noise * draw()).transpose();
  }
  return {points, plane};
}

double seconds(std::clock_t start) {
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

struct Found {
  symsurf::Plane plane;
  double cpu;
};

Found by_voting(const symsurf::Points& points) {
  VcgMesh mesh;
  auto vertex = vcg::tri::Allocator<VcgMesh>::AddVertices(mesh, points.rows());
  for (symsurf::Index i = 0; i < points.rows(); ++i, ++vertex)
    vertex->P() = vcg::Point3d(points(i, 0), points(i, 1), points(i, 2));
  vcg::tri::UpdateBounding<VcgMesh>::Box(mesh);
  const std::clock_t start = std::clock();
  vcg::tri::ExtrinsicPlaneSymmetry<VcgMesh> detector(mesh);
  detector.Init();
  std::vector<vcg::Plane3<double>> planes;
  detector.GetPlanes(planes, 1);
  const double cpu = seconds(start);
  const vcg::Point3d n = planes[0].Direction();
  return {symsurf::Plane({n[0], n[1], n[2]}, -planes[0].Offset()), cpu};
}

Found by_symsurf(const symsurf::Points& points) {
  symsurf::Options options;
  options.method = "plane";
  options.parameters = {{"max_candidates", symsurf::Index{0}}};  // the best plane alone, as above
  const std::clock_t start = std::clock();
  const symsurf::Result result = symsurf::detect(points, options, symsurf::Context({}, 1));
  const double cpu = seconds(start);
  return {dynamic_cast<const symsurf::Plane&>(*result.mirror), cpu};
}

void report(const char* name, const Found& found, const symsurf::Plane& truth) {
  const double cosine = found.plane.normal().dot(truth.normal());
  const double sine = found.plane.normal().cross(truth.normal()).norm();
  const double offset = found.plane.offset() - (cosine < 0 ? -1 : 1) * truth.offset();
  std::printf("  %-8s %9.4f s  normal off by %9.2e degrees, offset by %9.2e\n", name, found.cpu,
              std::atan2(sine, std::abs(cosine)) * 180 / M_PI, std::abs(offset));
}

}  // namespace

int main() {
  for (const double noise : {0.0, 0.01})
    for (unsigned seed = 0; seed < 3; ++seed) {
      const Scene s = scene(2000, seed, noise);
      const Found voted = by_voting(s.points), ours = by_symsurf(s.points);
      std::printf("2000 points, seed %u, noise %g: %.0f times faster\n", seed, noise,
                  voted.cpu / ours.cpu);
      report("MeshLab", voted, s.truth);
      report("symsurf", ours, s.truth);
    }
}
