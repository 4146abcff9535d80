#include "curvature.h"

#include <Eigen/Geometry>
#include <Eigen/IterativeLinearSolvers>

#include "cloud/laplacian.h"

namespace symsurf {

Eigen::VectorXd smoothed_mean_curvature(PointsView points, TrianglesView faces,
                                        const Points& normals, double scale,
                                        const Context& context) {
  constexpr double tolerance = 1e-12;
  constexpr Index most_steps = 300;
  const auto [stiffness, areas] = cotangent_laplacian(points, faces);
  // Twice the mean curvature times the normal, integrated over the cell of each vertex.
  Points finite = points.matrix();
  finite = finite.array().isFinite().select(finite, 0);  // vertices of no face may lie nowhere
  const Points bends = stiffness * finite;
  const double least = 1e-12 * areas.sum();  // a vertex of no face, which the stiffness has none of
  const Eigen::SparseMatrix<double> mass(areas.cwiseMax(least).asDiagonal());
  const Eigen::SparseMatrix<double> diffusion = scale * scale * stiffness + mass;
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver;
  solver.setTolerance(tolerance);
  solver.setMaxIterations(most_steps);
  solver.compute(diffusion);
  Points smoothed(points.size(), 3);
  for (int axis = 0; axis < 3; ++axis) {
    context.check();
    smoothed.col(axis) = solver.solve(Eigen::VectorXd(bends.col(axis)));
  }
  return smoothed.cwiseProduct(normals).rowwise().sum() / 2;
}

Points vertex_gradients(PointsView points, TrianglesView faces, const Eigen::VectorXd& values) {
  Points gradients = Points::Zero(points.size(), 3);
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(points.size());
  for (Index f = 0; f < faces.size(); ++f) {
    const Index* corner = faces[f];
    const Vector3 a = points[corner[0]], b = points[corner[1]], c = points[corner[2]];
    const Vector3 twice_area = (b - a).cross(c - a);
    const double area = twice_area.norm();
    if (!(area > 0)) continue;
    // Of the area times the gradient.
    const Vector3 gradient =
        twice_area.cross(values[corner[0]] * (c - b) + values[corner[1]] * (a - c) +
                         values[corner[2]] * (b - a)) /
        area;
    for (int k = 0; k < 3; ++k) {
      gradients.row(corner[k]) += gradient.transpose();
      areas[corner[k]] += area;
    }
  }
  for (Index i = 0; i < gradients.rows(); ++i)
    if (areas[i] > 0) gradients.row(i) /= areas[i];
  return gradients;
}

}  // namespace symsurf
