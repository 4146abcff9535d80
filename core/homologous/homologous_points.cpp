#include "homologous_points.h"

#include <algorithm>
#include <cmath>

#include "cloud/cloud.h"
#include "cloud/laplacian.h"

namespace symsurf {

namespace {

HomologousPoints pairs_of(const OperationInput& input, const SymmetryMap& map, PointsView images,
                          bool estimates, const Context& context) {
  const PointsView points = input.points;
  const TrianglesView faces = input.faces;
  const Eigen::MatrixXd& pairs = input.landmark_pairs;
  const DistinctPoints distinct = distinct_points(points, context.stage(0, 0.05));
  const Eigen::RowVector3d origin = points.matrix().colwise().mean();
  const double unit = box_of_radii * std::sqrt((points.matrix().rowwise() - origin).squaredNorm() /
                                               static_cast<double>(points.size()));
  const auto normalised = [&](const auto& all) -> Points {
    return (all.rowwise() - origin) / unit;
  };
  HomologousPoints found{Points::Zero(points.size(), 3), std::vector<Index>(points.size(), -1),
                         Eigen::VectorXd::Zero(points.size()),
                         Eigen::VectorXd::Ones(points.size())};
  if (!(unit > 0) || (faces.empty() && !estimates)) return found;
  const Points positions = normalised(points.matrix()(distinct.first, Eigen::indexing::all)),
               mirrored = normalised(images.matrix()(distinct.first, Eigen::indexing::all));
  const Context first = context.stage(0.05, 0.2);
  Triangles triangles(faces.size(), 3);
  for (Index f = 0; f < faces.size(); ++f)
    for (int c = 0; c < 3; ++c) triangles(f, c) = distinct.number[faces[f][c]];
  const auto images_of = [&](const Points& all, const Context& stage) -> Points {
    const Points own = (unit * all).rowwise() + origin;
    return normalised(map.images(own, stage));
  };
  // Of either landmark of a pair the other's image says where it should be.
  Points places(2 * pairs.rows(), 3), others = places;
  Eigen::VectorXd deviations(places.rows());
  if (pairs.rows() > 0) {
    places << pairs.leftCols(3), pairs.middleCols(3, 3);
    others << pairs.middleCols(3, 3), pairs.leftCols(3);
    deviations << pairs.col(6), pairs.col(6);
  }
  places = normalised(places);
  const Landmarks landmarks{places, images_of(normalised(others), first.stage(0, 0)) - places,
                            deviations / unit};
  if (faces.empty()) triangles = cloud_laplacian(positions, first).triangles;
  const TriangleMesh mesh(positions, triangles, context);
  std::vector<Index> table(positions.rows(), -1);
  const auto look_up = [&](const Displacements& displacements, const Context& stage) {
    if (!faces.empty())
      table = vertex_table(positions, mirrored, mesh.manifold_faces(), displacements, stage);
  };
  // Where nothing is to be estimated the table may slide as far as it ever may without.
  look_up({Points::Zero(positions.rows(), 3),
           Eigen::VectorXd::Constant(positions.rows(), estimates ? 0 : usual_slide / 2),
           {}},
          first);
  if (estimates && *std::min_element(table.begin(), table.end()) < 0) {
    const Displacements moved = displacement_process(
        positions, mirrored, triangles, mesh,
        [&](const Points& all) { return images_of(all, context.stage(0.9, 0.9)); }, landmarks,
        context.stage(0.2, 0.9));
    found.deviations = unit * moved.deviations(distinct.number);
    found.known = moved.known(distinct.number);
    found.displacements = unit * moved.mean(distinct.number, Eigen::indexing::all);
    look_up(moved, context.stage(0.9, 1));
  }
  for (Index i = 0; i < points.size(); ++i)
    if (const Index partner = table[distinct.number[i]]; partner >= 0) {
      found.partners[i] = distinct.first[partner];
      found.deviations[i] = 0;
      found.known[i] = 1;
    }
  return found;
}

}  // namespace

HomologousPoints homologous_points(const OperationInput& input, const SymmetryMap& map,
                                   PointsView images, const Context& context) {
  return pairs_of(input, map, images, true, context);
}

HomologousPoints vertex_pairs(const OperationInput& input, const SymmetryMap& map,
                              PointsView images, const Context& context) {
  return pairs_of(input, map, images, false, context);
}

}  // namespace symsurf
