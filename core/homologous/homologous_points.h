#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "cloud/triangle_mesh.h"
#include "operations/counterparts.h"

namespace symsurf {

/// The diagonal of a body's box, over the root mean square distance from its centroid, is about
/// this; and that distance is the same in any pose.
constexpr double box_of_radii = 4;

/// Of vertices at the most, diagonals.
constexpr double usual_slide = 0.01;

/// The displacements of points to their homologous points, across the surface and along it.
struct Displacements {
  Points mean;
  Eigen::VectorXd deviations;  ///< standard, of the part along the surface
  Eigen::VectorXd known;       ///< share of its variance that the shape explains, 0 to 1
};

/// Of each vertex the one that mirrors it, where both sides have one triangulation: of the maps of
/// each connected part onto itself or another the one that is nearest to displacements, as far as
/// these are certain; -1 where faces differ, and for parts that have no map of at least half of
/// their vertices.
/// Lengths are in diagonals.
std::vector<Index> vertex_table(PointsView points, PointsView images, TrianglesView faces,
                                const Displacements& displacements, const Context& context);

/// Places whose displacements are given, with their standard deviations in each direction.
struct Landmarks {
  Points places, moves;
  Eigen::VectorXd deviations;
};

/// Of points, their images; NaN where there are none.
using ImageOf = std::function<Points(const Points&)>;

/// The posterior of a Gaussian process (Rasmussen and Williams 2006) of which surface and image
/// show the part along their normals, and landmarks all of it: Matern 3/2 of length 0.12 diagonals,
/// and an affine field. Lengths are in diagonals; `images`: NaN where there are none.
Displacements displacement_process(PointsView points, PointsView images, TrianglesView faces,
                                   const TriangleMesh& mesh, const ImageOf& image_of,
                                   const Landmarks& landmarks, const Context& context);

/// The homologous points of a shape: vertices where both sides have one triangulation, else by
/// displacement_process(). `images`: of the points, NaN where there are none. Without faces the
/// points are a cloud, whose surface is that of cloud_laplacian().
HomologousPoints homologous_points(const OperationInput& input, const SymmetryMap& map,
                                   PointsView images, const Context& context);

/// The partners of vertices by the triangles alone, without displacements.
HomologousPoints vertex_pairs(const OperationInput& input, const SymmetryMap& map,
                              PointsView images, const Context& context);

/// The partners of vertices by the triangles alone, wherever a pose has put them: of the maps of
/// each connected part of the faces onto itself or another that turn the winding round and are
/// their own inverses the one that is nearest to the mirror's, or to what the largest part does
/// beside it. Takes time by the number of faces. Throws InvalidInput without faces, and where less
/// than half of the vertices have partners.
HomologousPoints topological_pairs(const OperationInput& input, const SymmetryMap& map,
                                   PointsView images, const Context& context);

}  // namespace symsurf
