#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <Eigen/Core>

namespace symsurf {

/// The mean curvature at the vertices of a surface, per length, smoothed over about `scale` by one
/// implicit step of diffusion (Desbrun et al. 1999). Its sign is that of the normals.
Eigen::VectorXd smoothed_mean_curvature(PointsView points, TrianglesView faces,
                                        const Points& normals, double scale,
                                        const Context& context);

/// The gradient of a function of the vertices: means over the faces around each, by their areas.
Points vertex_gradients(PointsView points, TrianglesView faces, const Eigen::VectorXd& values);

}  // namespace symsurf
