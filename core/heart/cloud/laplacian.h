#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <Eigen/SparseCore>

namespace symsurf {

/// The Laplace-Beltrami operator of a surface on functions of its points: u' stiffness v is the
/// integral of the product of their gradients, u' diag(areas) v that of their product.
struct Laplacian {
  Eigen::SparseMatrix<double> stiffness;  ///< symmetric, semidefinite, rows add up to 0
  Eigen::VectorXd areas;                  ///< of the points, square input units; 0 beside faces
};

/// By linear finite elements (Pinkall and Polthier 1993), on any faces. The edges of degenerate
/// faces are made longer by as little as gives all of them an area, a 1e-5th of an edge (Sharp and
/// Crane 2020, intrinsic mollification).
Laplacian cotangent_laplacian(PointsView points, TrianglesView faces);

/// The Laplacian of a surface that points lie on, with the triangles of each point and two
/// neighbours, wound alike where normals can be carried from point to point.
struct CloudLaplacian : Laplacian {
  Triangles triangles;
};

/// By finite volumes: each point's Voronoi cell among its neighbours in its tangent plane, as the
/// cotangents of a local Delaunay triangulation give (Luo, Safa and Wang 2009; Sharp and Crane
/// 2020). Weights are made symmetric by their mean. Points must be distinct.
CloudLaplacian cloud_laplacian(PointsView points, const Context& context);

}  // namespace symsurf
