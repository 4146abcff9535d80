#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "operations/counterparts.h"

namespace symsurf {

/// The vertices of a triangulated surface with the edges between them.
class SurfaceGraph {
 public:
  SurfaceGraph(PointsView points, TrianglesView faces);

  Index vertices() const { return static_cast<Index>(begin_.size()) - 1; }

  /// Vertices joined to this one by an edge, in ascending order, and the lengths of these edges.
  std::span<const std::int32_t> neighbours(Index vertex) const {
    return {neighbour_.data() + begin_[vertex], neighbour_.data() + begin_[vertex + 1]};
  }
  std::span<const double> lengths(Index vertex) const {
    return {length_.data() + begin_[vertex], length_.data() + begin_[vertex + 1]};
  }

  /// Whether the vertex ends an edge that one face alone has.
  bool is_boundary(Index vertex) const { return is_boundary_[vertex]; }

  bool are_neighbours(Index one, Index other) const;

  /// The third vertices of the faces at an edge; -1 where there is none, both of more than two.
  std::array<std::int32_t, 2> thirds(Index one, Index other) const;

 private:
  std::vector<Index> begin_;
  std::vector<std::int32_t> neighbour_;
  std::vector<double> length_;
  std::vector<std::array<std::int32_t, 2>> thirds_;
  std::vector<bool> is_boundary_;
};

/// A source of a search along edges, by its number, and how far it is.
struct NearSource {
  std::int32_t source = -1;
  double distance = 0;
};

/// Of each vertex up to k sources that are nearest along edges, nearest first (Dijkstra 1959, with
/// k labels a vertex): k places a vertex, source -1 where fewer can be reached.
std::vector<NearSource> nearest_sources(const SurfaceGraph& graph,
                                        const std::vector<Index>& sources, int k,
                                        const Context& context);

/// Of each vertex the one that mirrors it, where both sides have one triangulation: of the maps of
/// each connected part onto itself or another the one that is nearest to a registration; -1 where
/// faces differ, and for parts that have no map of at least half of their vertices.
/// Lengths are in diagonals; `displacements`: of the registration.
std::vector<Index> vertex_table(PointsView points, PointsView images, const SurfaceGraph& graph,
                                const Points& displacements, const Context& context);

/// The mean curvature at the vertices of a surface, per length, smoothed over about `scale` by one
/// implicit step of diffusion (Desbrun et al. 1999). Its sign is that of the normals.
Eigen::VectorXd smoothed_mean_curvature(PointsView points, TrianglesView faces,
                                        const Points& normals, double scale,
                                        const Context& context);

/// The gradient of a function of the vertices: means over the faces around each, by their areas.
Points vertex_gradients(PointsView points, TrianglesView faces, const Eigen::VectorXd& values);

/// Non-rigid registration of a triangulated surface onto its mirror image: of each vertex where its
/// homologous point of the image lies, from the vertex. Of all smooth
/// displacements onto the image that of least bending energy, as semilandmarks slide (Bookstein
/// 1997; Gunz and Mitteroecker 2013), with mean curvature to resist the sliding.
/// Lengths are in diagonals of the points; there must be faces, and they finite with their images.
Points registered_displacements(PointsView points, PointsView images, TrianglesView faces,
                                const SurfaceGraph& graph, const Context& context);

/// The homologous points of a shape by non-rigid registration with its image.
/// `images`: of the points, NaN where there are none. Without faces the points are a cloud, whose
/// surface is that of cloud_laplacian().
HomologousPoints homologous_points(PointsView points, TrianglesView faces, PointsView images,
                                   const Context& context);

/// The same by the triangles alone: the partners of vertices, without a registration.
HomologousPoints vertex_pairs(PointsView points, TrianglesView faces, PointsView images,
                              const Context& context);

}  // namespace symsurf
