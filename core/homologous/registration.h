#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <Eigen/Core>

#include "vertex_table.h"

namespace symsurf {

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

}  // namespace symsurf
