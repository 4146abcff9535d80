#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/math.h"
#include "base/parallel.h"
#include "cloud/closest_point_on_mesh.h"
#include "cloud/cloud.h"
#include "cloud/laplacian.h"
#include "cloud/point_tree.h"
#include "homologous_points.h"

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

namespace {

// Lengths are in diagonals.
constexpr Index most_nodes = 600;          // 300 leave 6 % more error, 1000 2 % less
constexpr int neighbourhood = 12;          // nodes that bending is measured among
constexpr int shared_by = 4;               // nodes that move a vertex
constexpr Index most_data = 100'000;       // vertices that are fitted
constexpr Index grain = 512;               // vertices; a closest point takes some microseconds
constexpr double curvature_scale = 0.002;  // coarser ones leave more error, alone and before it
constexpr double clipped = 4;              // standard deviations of curvature: creases, rims
// What a difference of curvature by its standard deviation counts for. A tenth and ten times its
// square leave 4 and 10 % more error.
constexpr double curvature_length = 0.018;
constexpr double least_cosine = 0.5;  // between the normals of counterparts
// Coarse to fine.
struct Stage {
  double bending;     // the squared length that a unit of its energy counts for
  double difference;  // of curvature that is usual: what lies far off its counterpart differs more,
                      // in the end a bump is none of its own image
};
constexpr std::array stages{Stage{3e-4, 4}, Stage{2e-5, 2}, Stage{1e-6, 0.6}};
constexpr int iterations = 3;      // in each
constexpr double damping = 1e-10;  // where nothing holds a node

// A symmetric sparse matrix of 3 x 3 blocks, its lower triangle.
class BlockMatrix {
 public:
  // The pairs of nodes that have a block, each with the lower node first.
  BlockMatrix(Index nodes, std::vector<std::array<std::int32_t, 2>> pairs) : rows_(nodes) {
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    for (const auto& [column, row] : pairs) rows_[column].push_back(row);
    matrix_.resize(3 * nodes, 3 * nodes);
    matrix_.reserve(9 * static_cast<Index>(pairs.size()));
    for (Index column = 0; column < 3 * nodes; ++column) {
      matrix_.startVec(column);
      for (const std::int32_t row : rows_[column / 3])
        for (int r = 0; r < 3; ++r) matrix_.insertBack(3 * row + r, column) = 0;
    }
    matrix_.finalize();
  }

  void set_zero() { matrix_.coeffs().setZero(); }

  void add(std::int32_t row, std::int32_t column, const Matrix3& block) {
    const auto& rows = rows_[column];
    const auto at = std::lower_bound(rows.begin(), rows.end(), row) - rows.begin();
    for (int c = 0; c < 3; ++c) {
      double* values = matrix_.valuePtr() + matrix_.outerIndexPtr()[3 * column + c] + 3 * at;
      for (int r = 0; r < 3; ++r) values[r] += block(r, c);
    }
  }

  const Eigen::SparseMatrix<double>& matrix() const { return matrix_; }

 private:
  std::vector<std::vector<std::int32_t>> rows_;
  Eigen::SparseMatrix<double> matrix_;
};

// The bending energy around a node: what the best affine map leaves of the displacements of its
// neighbours, that is local tangent space alignment (Zhang and Zha 2004). It is 0 for all affine
// maps, at rims too.
struct Bending {
  std::vector<std::int32_t> nodes;
  Eigen::MatrixXd energy;  // of the displacements of these nodes along one axis
};

Bending bending_around(const Points& nodes, Index node, const NearSource* near) {
  constexpr double ridge = 1e-3;       // on the slopes: a flat neighbourhood leaves one open
  constexpr double of_quadratic = 50;  // makes it about the integral of squared second derivatives
  Bending bending;
  double radius = 0;
  for (int k = 0; k < neighbourhood && near[k].source >= 0; ++k) {
    bending.nodes.push_back(near[k].source);
    radius = near[k].distance;
  }
  const auto count = static_cast<Index>(bending.nodes.size());
  if (!(radius > 0)) return {};
  Eigen::MatrixXd affine(count, 4);
  for (Index k = 0; k < count; ++k)
    affine.row(k) << 1, (nodes.row(bending.nodes[k]) - nodes.row(node)) / radius;
  Eigen::Matrix4d normal = affine.transpose() * affine;
  normal.diagonal().tail<3>().array() += ridge;
  const Eigen::MatrixXd left =
      Eigen::MatrixXd::Identity(count, count) - affine * normal.ldlt().solve(affine.transpose());
  bending.energy =
      left * left *
      (of_quadratic / (static_cast<double>(count * nodes.rows()) * std::pow(radius, 4)));
  return bending;
}

// The nodes that move a vertex, and their shares.
struct Shares {
  std::array<std::int32_t, shared_by> node;
  std::array<double, shared_by> share;
};

// Of surfaces in diagonals.
class Registration {
 public:
  Registration(PointsView points, PointsView images, TrianglesView faces, const SurfaceGraph& graph,
               const Context& context);

  Points displacements(const Context& context);

 private:
  // What a vertex asks of its displacement u: |left u - right|^2 small, summed up.
  struct Term {
    Matrix3 left = Matrix3::Zero();
    Vector3 right = Vector3::Zero();
  };

  void place_nodes(const Context& context);
  Term term(Index vertex, double usual_difference) const;
  Vector3 moved_by(Index vertex) const {
    Vector3 u = Vector3::Zero();
    for (int k = 0; k < shared_by; ++k)
      u += shares_[vertex].share[k] * moves_.row(shares_[vertex].node[k]).transpose();
    return u;
  }

  PointsView points_, images_;
  TrianglesView faces_;
  const SurfaceGraph& graph_;
  ClosestPointOnMesh image_surface_;
  Eigen::VectorXd areas_, curvature_, image_curvature_;
  Points normals_, image_normals_, image_gradients_;
  std::vector<Shares> shares_;
  std::vector<Bending> bending_;
  Points moves_;  // of the nodes
};

// Area-weighted.
Points normals_of(PointsView points, TrianglesView faces, Eigen::VectorXd* areas = nullptr) {
  Points normals = Points::Zero(points.size(), 3);
  if (areas) *areas = Eigen::VectorXd::Zero(points.size());
  for (Index f = 0; f < faces.size(); ++f) {
    const Vector3 x = points[faces[f][0]];
    const Vector3 normal = (points[faces[f][1]] - x).cross(points[faces[f][2]] - x);
    for (int c = 0; c < 3; ++c) {
      normals.row(faces[f][c]) += normal.transpose();
      if (areas) (*areas)[faces[f][c]] += normal.norm();
    }
  }
  for (Index i = 0; i < normals.rows(); ++i) normals.row(i) = normals.row(i).stableNormalized();
  return normals;
}

Registration::Registration(PointsView points, PointsView images, TrianglesView faces,
                           const SurfaceGraph& graph, const Context& context)
    : points_(points),
      images_(images),
      faces_(faces),
      graph_(graph),
      image_surface_(images, faces, context.stage(0, 0.2)),
      normals_(normals_of(points, faces, &areas_)),
      image_normals_(-normals_of(images, faces)) {  // a mirror turns the winding round
  areas_ /= areas_.sum();
  curvature_ =
      smoothed_mean_curvature(points, faces, normals_, curvature_scale, context.stage(0.2, 0.4));
  image_curvature_ = smoothed_mean_curvature(images, faces, image_normals_, curvature_scale,
                                             context.stage(0.4, 0.6));
  const double deviation = std::sqrt(areas_.dot(curvature_.cwiseAbs2()));
  if (deviation > 0)
    for (Eigen::VectorXd* curvature : {&curvature_, &image_curvature_})
      *curvature = (*curvature / deviation).cwiseMax(-clipped).cwiseMin(clipped);
  image_gradients_ = vertex_gradients(images, faces, image_curvature_);
  place_nodes(context.stage(0.6, 1));
}

void Registration::place_nodes(const Context& context) {
  const std::vector<Index> nodes =
      farthest_points(points_, std::min(most_nodes, points_.size()), context);
  const Points positions = points_.matrix()(nodes, Eigen::indexing::all);
  const auto near = nearest_sources(graph_, nodes, neighbourhood, context);
  for (std::size_t k = 0; k < nodes.size(); ++k)
    bending_.push_back(
        bending_around(positions, static_cast<Index>(k), &near[nodes[k] * neighbourhood]));
  moves_ = Points::Zero(positions.rows(), 3);
  const PointTree tree(positions, context);
  shares_.resize(points_.size());
  for (Index i = 0; i < points_.size(); ++i) {
    const NearSource* found = &near[i * neighbourhood];
    Shares& shares = shares_[i];
    shares.node.fill(0);
    shares.share.fill(0);
    if (found[0].source < 0) {  // of another part of the surface, or of none
      shares.node[0] = static_cast<std::int32_t>(tree.nearest(points_[i]).index);
      shares.share[0] = 1;
      continue;
    }
    const double reach = found[shared_by].source < 0 ? infinity : found[shared_by].distance;
    double sum = 0;
    for (int k = 0; k < shared_by && found[k].source >= 0; ++k) {
      const double off = found[k].distance / reach;
      shares.node[k] = found[k].source;
      shares.share[k] = reach > 0 ? (1 - off * off) * (1 - off * off) + 1e-12 : 1;
      sum += shares.share[k];
    }
    for (double& share : shares.share) share /= sum;
  }
}

Registration::Term Registration::term(Index vertex, double usual_difference) const {
  const Vector3 x = points_[vertex];
  const ClosestPoint closest = image_surface_(x + moved_by(vertex));
  if (closest.face < 0) return {};
  Vector3 normal = Vector3::Zero(), gradient = Vector3::Zero();
  double curvature = 0;
  bool on_rim = true;
  for (int k = 0; k < 3; ++k) {
    const Index corner = faces_[closest.face][k];
    const double weight = closest.weights[k];
    normal += weight * image_normals_.row(corner).transpose();
    gradient += weight * image_gradients_.row(corner).transpose();
    curvature += weight * image_curvature_[corner];
    on_rim = on_rim && (weight < single_rounding || graph_.is_boundary(corner));
  }
  normal.stableNormalize();
  if (on_rim || !(normal.dot(normals_.row(vertex).transpose()) > least_cosine)) return {};
  gradient -= gradient.dot(normal) * normal;
  const Vector3 way = closest.point - x;
  const double difference = curvature_[vertex] - curvature, off = difference / usual_difference;
  const double kernel = 1 / ((1 + off * off) * (1 + off * off));  // Geman and McClure
  const double weight = curvature_length * curvature_length * kernel;
  Term term;
  term.left =
      areas_[vertex] * (normal * normal.transpose() + weight * gradient * gradient.transpose());
  term.right = areas_[vertex] *
               (normal.dot(way) * normal + weight * (difference + gradient.dot(way)) * gradient);
  return term;
}

Points Registration::displacements(const Context& context) {
  const Index nodes = moves_.rows();
  const Index stride = (points_.size() + most_data - 1) / most_data;
  const Index data = (points_.size() + stride - 1) / stride;
  std::vector<std::array<std::int32_t, 2>> pairs;
  for (Index d = 0; d < data; ++d)
    for (const std::int32_t one : shares_[d * stride].node)
      for (const std::int32_t other : shares_[d * stride].node)
        if (one <= other) pairs.push_back({one, other});
  for (const Bending& bending : bending_)
    for (const std::int32_t one : bending.nodes)
      for (const std::int32_t other : bending.nodes)
        if (one <= other) pairs.push_back({one, other});
  for (std::int32_t k = 0; k < nodes; ++k) pairs.push_back({k, k});
  BlockMatrix normal_equations(nodes, std::move(pairs));
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
  solver.analyzePattern(normal_equations.matrix());
  std::vector<Term> terms(data);
  const int rounds = iterations * static_cast<int>(stages.size());
  for (int round = 0; round < rounds; ++round) {
    const Stage& stage = stages[round / iterations];
    const Context part = context.stage(1.0 * round / rounds, 1.0 * (round + 1) / rounds);
    parallel_for(part.stage(0, 0.8), data, grain, [&](Index begin, Index end) {
      for (Index d = begin; d < end; ++d) terms[d] = term(d * stride, stage.difference);
    });
    normal_equations.set_zero();
    Eigen::VectorXd right = Eigen::VectorXd::Zero(3 * nodes);
    const double scale = static_cast<double>(stride);
    interruptible_for(part, data, [&](Index d) {
      const auto& [node, share] = shares_[d * stride];
      for (int k = 0; k < shared_by; ++k) {
        right.segment<3>(3 * node[k]) += scale * share[k] * terms[d].right;
        for (int l = 0; l < shared_by; ++l)
          if (node[l] <= node[k])
            normal_equations.add(node[k], node[l], scale * share[k] * share[l] * terms[d].left);
      }
    });
    for (const auto& [node, energy] : bending_)
      for (std::size_t k = 0; k < node.size(); ++k)
        for (std::size_t l = 0; l < node.size(); ++l)
          if (node[l] <= node[k])
            normal_equations.add(node[k], node[l],
                                 stage.bending *
                                     energy(static_cast<Index>(k), static_cast<Index>(l)) *
                                     Matrix3::Identity());
    for (std::int32_t k = 0; k < nodes; ++k)
      normal_equations.add(k, k, damping * Matrix3::Identity());
    solver.factorize(normal_equations.matrix());
    const Eigen::VectorXd solution = solver.solve(right);
    if (solver.info() != Eigen::Success || !solution.allFinite()) break;
    moves_ = Eigen::Map<const Points>(solution.data(), nodes, 3);
    part.report(1);
  }
  Points moved(points_.size(), 3);
  for (Index i = 0; i < moved.rows(); ++i) moved.row(i) = moved_by(i).transpose();
  return moved;
}

}  // namespace

Points registered_displacements(PointsView points, PointsView images, TrianglesView faces,
                                const SurfaceGraph& graph, const Context& context) {
  Registration registration(points, images, faces, graph, context.stage(0, 0.5));
  return registration.displacements(context.stage(0.5, 1));
}

}  // namespace symsurf
