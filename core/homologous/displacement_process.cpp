#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/math.h"
#include "base/parallel.h"
#include "cloud/closest_point_on_mesh.h"
#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "homologous_points.h"
#include "preprocess/surface_samples.h"

namespace symsurf {

namespace {

// Of the prior, in diagonals and in standard deviations of the displacement. The length was chosen
// on five scanned faces with landmarks.
constexpr double correlation_length = 0.12;
constexpr double affine_deviation = 0.85;
constexpr double amplitude = 1.2;      // over the root mean square of the normal parts
constexpr double least_scale = 1e-12;  // diagonals
// Of the deviations: errors are then about one of them, 0.5 to 1.4 in the median of each of the
// bodies of `make accuracy OPTIONS="--cases homologous --seeds 8"`.
constexpr double calibration = 0.85;
// Of an observation.
constexpr double noise = 0.09;
constexpr double large_error = 4;  // noises: it counts a quarter
constexpr double no_weight = 1e3;
constexpr double deviations_of_median = 1.4826;
constexpr double least_cosine = 0.5;  // of a normal and the mean of it and its counterpart's

constexpr Index samples_of_rounds[]{800, 800, 3000};  // the first look for the closest points

constexpr Index nodes_of_deviations = 500;
constexpr Index neighbours_of_nodes = 4;
constexpr Index grain = 64;  // places, each beside all observations

// Of one component of the displacement at each two places: Matern 3/2, and an affine field.
Eigen::MatrixXd covariance(const Points& a, const Points& b) {
  const Eigen::MatrixXd products = a * b.transpose();
  Eigen::ArrayXXd r = -2 * products.array();
  r.colwise() += a.rowwise().squaredNorm().array();
  r.rowwise() += b.rowwise().squaredNorm().transpose().array();
  r = r.max(0).sqrt() * (std::sqrt(3.0) / correlation_length);
  return (1 + r) * (-r).exp() +
         affine_deviation * affine_deviation * (1 + box_of_radii * box_of_radii * products.array());
}

// One component of the displacement at each of some places.
struct Observations {
  Points places, directions;
  Eigen::VectorXd values, deviations, arcs;  // arcs: heights of the surface above its faces

  // All components at those landmarks that have an image.
  void add(const Landmarks& landmarks, double standard_deviation) {
    for (Index i = 0; i < landmarks.places.rows(); ++i) {
      if (!landmarks.moves.row(i).allFinite()) continue;
      const Index seen = values.size();
      places.conservativeResize(seen + 3, 3);
      directions.conservativeResize(seen + 3, 3);
      values.conservativeResize(seen + 3);
      deviations.conservativeResize(seen + 3);
      places.bottomRows(3).rowwise() = landmarks.places.row(i);
      directions.bottomRows(3).setIdentity();
      values.tail(3) = landmarks.moves.row(i).transpose();
      deviations.tail(3).setConstant(landmarks.deviations[i] / standard_deviation + noise);
    }
  }
};

// The process given the observations; deviations over those of the prior.
class Posterior {
 public:
  Posterior() = default;
  explicit Posterior(Observations observed) : observed_(std::move(observed)) {
    const auto& [places, directions, values, deviations, arcs] = observed_;
    Eigen::MatrixXd covariances =
        covariance(places, places).cwiseProduct(directions * directions.transpose());
    covariances.diagonal() += deviations.cwiseAbs2();
    factor_.compute(covariances);
    weighted_ = Eigen::VectorXd(factor_.solve(values)).asDiagonal() * directions;
  }

  Points mean(const Points& places, const Context& context) const {
    Points means = Points::Zero(places.rows(), 3);
    parallel_for(
        context, weighted_.rows() == 0 ? 0 : places.rows(), grain, [&](Index begin, Index end) {
          means.middleRows(begin, end - begin) =
              covariance(places.middleRows(begin, end - begin), observed_.places) * weighted_;
        });
    return means;
  }

  // Of each place the deviation along the surface, and the share of its variance that the
  // observations take away.
  Eigen::MatrixX2d uncertainties(const Points& places, const Points& normals,
                                 const Context& context) const {
    Eigen::MatrixX2d found(places.rows(), 2);
    parallel_for(context, places.rows(), grain, [&](Index begin, Index end) {
      const Points here = places.middleRows(begin, end - begin);
      const Eigen::MatrixXd covariances = covariance(observed_.places, here);
      const Eigen::VectorXd before = 2 * covariance(here, here).diagonal();
      Eigen::VectorXd after = before;
      Points tangents = here;
      for (int axis = 0; axis < 2 && weighted_.rows() > 0; ++axis) {
        for (Index i = begin; i < end; ++i)
          tangents.row(i - begin) = orthogonal_to(normals.row(i).transpose()).col(axis).transpose();
        Eigen::MatrixXd seen =
            covariances.cwiseProduct(observed_.directions * tangents.transpose());
        factor_.matrixL().solveInPlace(seen);
        after -= seen.colwise().squaredNorm().transpose();
      }
      after = after.cwiseMax(0);
      found.middleRows(begin, end - begin) << after.cwiseSqrt(),
          1 - after.cwiseQuotient(before).array();
    });
    return found;
  }

 private:
  Observations observed_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Points weighted_ = Points(0, 3);  // the directions by what each counts
};

// Of what the corners of a face have.
Vector3 between(const Points& values, const Index* corner, const Vector3& weights) {
  return weights[0] * values.row(corner[0]).transpose() +
         weights[1] * values.row(corner[1]).transpose() +
         weights[2] * values.row(corner[2]).transpose();
}

// A surface beside its image.
class Comparison {
 public:
  Comparison(PointsView points, PointsView images, TrianglesView faces, const TriangleMesh& mesh,
             const Context& context)
      : faces_(faces),
        points_(points.matrix()),
        normals_(mesh.vertex_normals()),
        // A mirror turns the winding round.
        image_normals_(-mesh.vertex_normals(TriangleMesh::Weight::Angle, images)),
        is_boundary_(mesh.is_boundary()),
        image_surface_(images, faces, context) {
    for (Index f = 0; f < faces.size(); ++f) {
      const Vector3 x = points[faces[f][0]];
      areas_.push_back((points[faces[f][1]] - x).cross(points[faces[f][2]] - x).norm());
      // An arc's height above its chord is an eighth of this times the turn of the normal.
      arcs_.push_back(0);
      for (int c = 0; c < 3; ++c) {
        const Index a = faces[f][c], b = faces[f][(c + 1) % 3];
        arcs_[f] = std::max(arcs_[f], (points[a] - points[b]).norm() / 8 *
                                          (normals_.row(a) - normals_.row(b)).norm());
      }
    }
  }

  const Points& normals() const { return normals_; }

  // Of about so many samples the part of the displacement along the mean of their normal and that
  // of the image where the displacement so far leads, with the error that this leaves. None at
  // rims, and where the normals disagree.
  Observations observations(Index about, const Posterior& so_far, const Context& context) const {
    const std::vector<FaceSample> samples = even_face_samples(areas_, about);
    const auto count = static_cast<Index>(samples.size());
    Observations all{Points(count, 3), Points(count, 3), Eigen::VectorXd(count),
                     Eigen::VectorXd::Constant(count, infinity), Eigen::VectorXd(count)};
    for (Index s = 0; s < count; ++s) {
      const auto& [face, down, along] = samples[s];
      const Vector3 weights(1 - down, down * (1 - along), down * along);
      all.places.row(s) = between(points_, faces_[face], weights).transpose();
      all.directions.row(s) =
          between(normals_, faces_[face], weights).stableNormalized().transpose();
    }
    const Points moves = so_far.mean(all.places, context);
    parallel_for(context, count, grain, [&](Index begin, Index end) {
      for (Index s = begin; s < end; ++s) {
        const Vector3 x = all.places.row(s).transpose(), move = moves.row(s).transpose(),
                      normal = all.directions.row(s).transpose();
        const ClosestPoint closest = image_surface_(x + move);
        if (closest.face < 0) continue;
        const Index* corner = faces_[closest.face];
        bool on_rim = true;
        for (int k = 0; k < 3; ++k)
          on_rim = on_rim && (closest.weights[k] < single_rounding || is_boundary_[corner[k]]);
        const Vector3 other = between(image_normals_, corner, closest.weights).stableNormalized();
        const Vector3 direction = (normal + other).stableNormalized();
        all.directions.row(s) = direction.transpose();
        all.values[s] = direction.dot(closest.point - x);
        all.arcs[s] = std::hypot(arcs_[samples[s].face], arcs_[closest.face]);
        if (!on_rim && direction.dot(normal) > least_cosine)
          all.deviations[s] = all.values[s] - direction.dot(move);
      }
    });
    std::vector<Index> kept;
    for (Index s = 0; s < count; ++s)
      if (std::isfinite(all.deviations[s])) kept.push_back(s);
    return {all.places(kept, Eigen::indexing::all), all.directions(kept, Eigen::indexing::all),
            all.values(kept), all.deviations(kept), all.arcs(kept)};
  }

  // The mean of the way there and the way back from there: one is the other's inverse.
  void average_ways(Points& moves, const ImageOf& image_of, const Context& context) const {
    const ClosestPointOnMesh surface(points_, faces_, context);
    Points back = image_of(points_ + moves);
    parallel_for(context, back.rows(), grain, [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i)
        if (const ClosestPoint closest = surface(back.row(i).transpose()); closest.face >= 0)
          back.row(i) += between(moves, faces_[closest.face], closest.weights).transpose();
    });
    back = image_of(back) - points_;
    for (Index i = 0; i < back.rows(); ++i)
      if (back.row(i).allFinite()) moves.row(i) -= back.row(i) / 2;
  }

 private:
  TrianglesView faces_;
  Points points_, normals_, image_normals_;
  std::vector<bool> is_boundary_;
  ClosestPointOnMesh image_surface_;
  std::vector<double> areas_, arcs_;
};

}  // namespace

Displacements displacement_process(PointsView points, PointsView images, TrianglesView faces,
                                   const TriangleMesh& mesh, const ImageOf& image_of,
                                   const Landmarks& landmarks, const Context& context) {
  const Comparison comparison(points, images, faces, mesh, context.stage(0, 0.1));
  const Context process = context.stage(0.1, 0.6);
  Posterior posterior;
  double scale = 0;  // root mean square of the first values
  for (const Index about : samples_of_rounds) {
    Observations seen = comparison.observations(about, posterior, process);
    if (seen.values.size() == 0) break;
    if (scale == 0) scale = least_scale + std::sqrt(seen.values.cwiseAbs2().mean());
    const Eigen::ArrayXd errors = seen.deviations.array().abs() / (amplitude * scale);
    const double usual = std::max(
        noise, deviations_of_median * median(std::vector<double>(errors.begin(), errors.end())));
    const Eigen::ArrayXd noises =
        (usual * usual + (seen.arcs.array() / (amplitude * scale)).square()).sqrt();
    seen.deviations = noises * (1 + (errors / (large_error * noises)).square()).min(no_weight);
    seen.add(landmarks, amplitude * scale);
    posterior = Posterior(std::move(seen));
    process.report(static_cast<double>(about) / samples_of_rounds[2]);
  }
  Points moves = posterior.mean(points.matrix(), context.stage(0.6, 0.8));
  comparison.average_ways(moves, image_of, context.stage(0.8, 0.9));
  const std::vector<Index> nodes = farthest_points(points, nodes_of_deviations, context);
  const Points places = chosen_rows(points, nodes);
  const Points normals = chosen_rows(comparison.normals(), nodes);
  const Eigen::MatrixX2d uncertainties =
      posterior.uncertainties(places, normals, context.stage(0.9, 1));
  const PointTree tree(places, context);
  Displacements found{std::move(moves), Eigen::VectorXd(points.size()),
                      Eigen::VectorXd(points.size())};
  parallel_for(context, points.size(), grain, [&](Index begin, Index end) {
    std::vector<Neighbour> near;
    for (Index i = begin; i < end; ++i) {
      tree.nearest(points[i], neighbours_of_nodes, near);
      double weights = 0;
      Eigen::RowVector2d sum(0, 0);
      for (const auto& [node, squared] : near) {
        const double weight = 1 / (squared + double_rounding);
        weights += weight;
        sum += weight * uncertainties.row(node);
      }
      found.deviations[i] = calibration * scale * sum[0] / weights;
      found.known[i] = sum[1] / weights;
    }
  });
  return found;
}

}  // namespace symsurf
