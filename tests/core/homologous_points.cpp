#include <gtest/gtest.h>
#include <symsurf/mirrors.h>
#include <symsurf/operations.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <queue>
#include <string>
#include <vector>

#include "base/math.h"
#include "bumpy_ball.h"
#include "cloud/footprint.h"
#include "expect_error.h"
#include "figure.h"
#include "operations/homologous/curvature.h"
#include "operations/homologous/surface_graph.h"
#include "random_cloud.h"

namespace symsurf {
namespace {

constexpr double share_of_diagonal = 0.02;  // that a side is deformed by at the most

// A body that mirrors itself over x = 0, with features of a face's kind.
Vector3 on_body(const Vector3& u) {
  const double even = u.x() * u.x();
  const double radius = 1 + 0.1 * std::sin(3 * u.y() + 1) + 0.1 * u.z() * even +
                        0.06 * std::sin(7 * u.z() + 2 * u.y()) * (1 - even) +
                        0.05 * std::cos(9 * u.x()) * std::cos(5 * u.y());
  return radius * u;
}

Ball mirrored_body(std::uint64_t seed) {
  Ball b = ball(seed);
  for (Index i = 0; i < b.points.rows(); ++i)
    b.points.row(i) = on_body(b.points.row(i).normalized().transpose()).transpose();
  return b;
}

// The same body where no vertex has a twin: the poles lie askew.
Ball resampled_body(std::uint64_t seed) {
  Ball b = ball(seed);
  const Matrix3 askew = RandomCloud(100 + seed).rotation();
  for (Index i = 0; i < b.points.rows(); ++i)
    b.points.row(i) = on_body(askew * b.points.row(i).normalized().transpose()).transpose();
  b.partner.clear();
  return b;
}

// Moves the positive side, in all directions: three plane waves.
class SideMap {
 public:
  SideMap(std::uint64_t seed, double amplitude) : amplitude_(amplitude) {
    RandomCloud random(200 + seed);
    for (int k = 0; k < 3; ++k) {
      wave_[k] = random.uniform(0.5, 2.5) * random.direction();
      way_[k] = random.direction();
      phase_[k] = random.uniform(0, 6);
    }
  }

  Vector3 operator()(const Vector3& x) const {
    Vector3 moved = Vector3::Zero();
    for (int k = 0; k < 3; ++k) moved += std::sin(wave_[k].dot(x) + phase_[k]) * way_[k];
    return x + amplitude_ / (1 + std::exp(-8 * x.x())) * moved / 2;
  }

 private:
  double amplitude_;
  Vector3 wave_[3], way_[3];
  double phase_[3];
};

// A body with one side deformed, and where each of its points should be.
struct Deformed {
  Points points, places;
  Triangles faces;
};

Deformed deformed(const Ball& body, const SideMap& map, bool bent) {
  Deformed d{body.points, body.points, body.faces};
  const Vector3 over(-1, 1, 1);
  for (Index i = 0; i < d.points.rows(); ++i) {
    const Vector3 x = body.points.row(i).transpose();
    d.points.row(i) = map(x).transpose();
    d.places.row(i) = map(x.cwiseProduct(over)).cwiseProduct(over).transpose();
  }
  if (bent) {
    d.points = wrapped(d.points);
    d.places = wrapped(d.places);
  }
  return d;
}

const Mirror& mirror_of(bool bent) {
  return bent ? static_cast<const Mirror&>(round_mirror) : middle;
}

const Values homologous{{"pairing", std::string("homologous")}};

double median_error(const OperationResult& result, const Deformed& truth) {
  std::vector<double> errors, lengths;
  for (Index i = 0; i < truth.points.rows(); ++i) {
    if (result.arrays.at("matched")(i, 0) == 0) continue;
    const Vector3 expected = (truth.places.row(i) - truth.points.row(i)).transpose();
    errors.push_back((result.arrays.at("vector").row(i).transpose() - expected).norm());
    lengths.push_back(expected.norm());
  }
  return median(errors) / median(lengths);
}

TEST(HomologousPoints, FollowASmoothDeformationWithoutTwins) {
  for (std::uint64_t seed = 0; seed < 4; ++seed)
    for (const bool bent : {false, true}) {
      const Ball body = resampled_body(seed);
      const double diagonal = diagonal_of(body.points);
      const Deformed d = deformed(body, SideMap(seed, share_of_diagonal * diagonal), bent);
      const OperationResult closest = operate("asymmetry", {d.points, d.faces}, mirror_of(bent));
      const OperationResult result =
          operate("asymmetry", {d.points, d.faces}, mirror_of(bent), homologous);
      EXPECT_GT(figure(result, "matched_share"), 0.99);
      EXPECT_LE(median_error(result, d), 0.35) << seed << ' ' << bent;
      EXPECT_GE(median_error(closest, d), 0.4) << seed << ' ' << bent;
    }
}

// But for the diagonals of its quadrangles, which are drawn on both sides apart.
TEST(HomologousPoints, OfOneTriangulationAreItsVertices) {
  for (std::uint64_t seed = 0; seed < 4; ++seed)
    for (const bool bent : {false, true}) {
      const Ball body = mirrored_body(seed);
      const double diagonal = diagonal_of(body.points);
      const Deformed d = deformed(body, SideMap(seed, share_of_diagonal * diagonal), bent);
      const OperationResult result =
          operate("asymmetry", {d.points, d.faces}, mirror_of(bent), homologous);
      const OperationResult pairs =
          operate("correspondences", {d.points, d.faces}, mirror_of(bent), homologous);
      Index exact = 0, partners = 0;
      for (Index i = 0; i < d.points.rows(); ++i) {
        const auto expected = d.places.row(i) - d.points.row(i);
        exact += (result.arrays.at("vector").row(i) - expected).norm() <= 1e-9 * diagonal;
        partners += pairs.arrays.at("index")(i, 0) == static_cast<double>(body.partner[i]);
      }
      EXPECT_GE(static_cast<double>(exact), 0.9 * static_cast<double>(d.points.rows()))
          << seed << ' ' << bent;
      EXPECT_GE(partners, exact);
    }
}

TEST(HomologousPoints, LeaveABumpABump) {
  for (std::uint64_t seed = 0; seed < 3; ++seed)
    for (const bool has_twins : {false, true})
      for (const bool bent : {false, true}) {
        const Ball body = has_twins ? mirrored_body(seed) : resampled_body(seed);
        Eigen::VectorXd raised;
        Points points = bumped(body.points, share_of_diagonal * diagonal_of(body.points), raised);
        Index highest;
        raised.maxCoeff(&highest);
        const Points flat = bent ? wrapped(body.points) : body.points;
        if (bent) points = wrapped(points);
        const double height = (points.row(highest) - flat.row(highest)).norm();
        const OperationResult result =
            operate("asymmetry", {points, body.faces}, mirror_of(bent), homologous);
        EXPECT_GE(result.arrays.at("distance")(highest, 0), 0.95 * height) << seed << bent;
        EXPECT_LE(std::abs(result.arrays.at("signed")(highest, 0)), 1.3 * height) << seed << bent;
      }
}

TEST(HomologousPoints, OfAMirroredBodyAreItsMirrorPoints) {
  const Ball b = mirrored_body(1);
  for (const bool has_faces : {true, false}) {
    const OperationResult result =
        operate("asymmetry", {b.points, has_faces ? b.faces : TrianglesView()}, middle, homologous);
    EXPECT_EQ(figure(result, "matched_share"), 1);
    EXPECT_LE(figure(result, "maximum_of_diagonal"), has_faces ? 1e-12 : 1e-6);
  }
}

TEST(HomologousPoints, OfACloudAreThoseOfItsSurface) {
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const Ball body = resampled_body(seed);
    Deformed d = deformed(body, SideMap(seed, share_of_diagonal * diagonal_of(body.points)), false);
    const OperationResult result = operate("asymmetry", {d.points}, middle, homologous);
    EXPECT_GT(figure(result, "matched_share"), 0.9);
    EXPECT_LE(median_error(result, d), 0.35) << seed;
  }
}

TEST(HomologousPoints, HaveTheSameBitsForAnyNumberOfThreads) {
  const Ball body = resampled_body(2);
  const Deformed d = deformed(body, SideMap(2, 0.05), true);
  const OperationResult one =
      operate("asymmetry", {d.points, d.faces}, round_mirror, homologous, Context(nullptr, 1));
  const OperationResult three =
      operate("asymmetry", {d.points, d.faces}, round_mirror, homologous, Context(nullptr, 3));
  for (const auto& [name, values] : one.arrays)
    EXPECT_TRUE((values.array() == three.arrays.at(name).array() ||
                 (values.array().isNaN() && three.arrays.at(name).array().isNaN()))
                    .all())
        << name;
}

TEST(HomologousPoints, ComeInAnyUnitAndPose) {
  const Ball body = resampled_body(3);
  const Deformed d = deformed(body, SideMap(3, 0.05), false);
  const OperationResult here = operate("asymmetry", {d.points, d.faces}, middle, homologous);
  for (const double scale : {1e-6, 1e6}) {
    const Matrix3 turn = RandomCloud(7).rotation();
    const Vector3 shift = scale * Vector3(2, -1, 3);
    const Points points = (scale * d.points * turn.transpose()).rowwise() + shift.transpose();
    const OperationResult there = operate("asymmetry", {points, d.faces},
                                          *middle.transformed(scale, turn, shift), homologous);
    const Points back = there.arrays.at("vector") * turn / scale;
    const auto apart = (back - here.arrays.at("vector")).rowwise().norm().array();
    std::vector<double> all(apart.begin(), apart.end());
    std::erase_if(all, [](double each) { return std::isnan(each); });
    EXPECT_GT(all.size(), 0.99 * static_cast<double>(d.points.rows()));
    EXPECT_LE(median(all), 1e-6 * diagonal_of(d.points)) << scale;
    EXPECT_LE(*std::max_element(all.begin(), all.end()), 1e-3 * diagonal_of(d.points)) << scale;
  }
}

TEST(HomologousPoints, SayHowSureTheyAre) {
  const Ball body = resampled_body(4);
  const Deformed d = deformed(body, SideMap(4, 0.05), false);
  const OperationResult result = operate("asymmetry", {d.points, d.faces}, middle, homologous);
  const Eigen::MatrixXd& confidence = result.arrays.at("confidence");
  EXPECT_GE(confidence.minCoeff(), 0);
  EXPECT_LE(confidence.maxCoeff(), 1);
  EXPECT_GT(confidence.mean(), 0.8);
  const Eigen::MatrixXd &vector = result.arrays.at("vector"), &face = result.arrays.at("face"),
                        &weights = result.arrays.at("weights");
  for (Index i = 0; i < d.points.rows(); ++i) {
    if (result.arrays.at("matched")(i, 0) == 0) continue;
    Vector3 target = Vector3::Zero();
    for (int c = 0; c < 3; ++c)
      target +=
          weights(i, c) * d.points.row(d.faces(static_cast<Index>(face(i, 0)), c)).transpose();
    const Vector3 place = (d.points.row(i) + vector.row(i)).transpose();
    EXPECT_LE((middle.reflect(target) - place).norm(), 1e-9) << i;
    const double normal = result.arrays.at("signed")(i, 0),
                 along = result.arrays.at("tangential")(i, 0);
    EXPECT_NEAR(std::hypot(normal, along), result.arrays.at("distance")(i, 0), 1e-9);
  }
}

// A point of no face has none; those of the others are the same with it.
TEST(HomologousPoints, PassOverPointsOfNoFace) {
  const Ball body = resampled_body(0);
  Points more(body.points.rows() + 3, 3);
  more << body.points, 0.1 * Points::Ones(3, 3);
  more.row(more.rows() - 1) *= 2;
  const OperationResult with = operate("asymmetry", {more, body.faces}, middle, homologous);
  EXPECT_TRUE(with.arrays.at("vector").topRows(body.points.rows()).allFinite());
  EXPECT_GT(with.arrays.at("matched").mean(), 0.9);
}

TEST(HomologousPoints, StopWhenAsked) {
  const Ball body = resampled_body(5);
  for (const double at : {0.3, 0.5, 0.7})
    EXPECT_THROW(operate("asymmetry", {body.points, body.faces}, middle, homologous,
                         Context([&](double done) { return done < at; })),
                 Cancelled);
}

TEST(HomologousPoints, AreAskedForByName) {
  const Ball body = ball(6);
  for (const std::string text : {"nearest", "closest | homologous"})
    expect_error<InvalidParameter>(text, [&] {
      operate("asymmetry", {body.points, body.faces}, middle,
              {{"pairing", std::string("nearest")}});
    });
}

TEST(SurfaceGraph, FindsTheNearestSourcesAlongEdges) {
  const Ball b = ball(7);
  const SurfaceGraph graph(b.points, b.faces);
  const std::vector<Index> sources{5, 77, 300, 301, 900, 1200, 1489};
  const auto near = nearest_sources(graph, sources, 3, {});
  std::vector<Eigen::VectorXd> distances;
  for (const Index source : sources) {  // Bellman and Ford
    Eigen::VectorXd distance = Eigen::VectorXd::Constant(b.points.rows(), infinity);
    distance[source] = 0;
    for (bool changes = true; changes;) {
      changes = false;
      for (Index v = 0; v < b.points.rows(); ++v)
        for (const std::int32_t w : graph.neighbours(v)) {
          const double way = distance[v] + (b.points.row(v) - b.points.row(w)).norm();
          if (way < distance[w] - 1e-12) {
            distance[w] = way;
            changes = true;
          }
        }
    }
    distances.push_back(distance);
  }
  for (Index v = 0; v < b.points.rows(); ++v) {
    std::vector<double> all;
    for (const Eigen::VectorXd& distance : distances) all.push_back(distance[v]);
    std::sort(all.begin(), all.end());
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(near[3 * v + k].distance, all[k], 1e-9);
  }
}

TEST(Curvature, OfASphereIsOneOverItsRadius) {
  Ball b = ball(8);
  for (Index i = 0; i < b.points.rows(); ++i) b.points.row(i) *= 2 / b.points.row(i).norm();
  const Points normals = b.points / 2;
  const Eigen::VectorXd curvature =
      smoothed_mean_curvature(b.points, b.faces, normals, 0.1, Context());
  // More where the faces are long and thin, at the poles.
  for (Index i = 0; i < curvature.size(); ++i) EXPECT_NEAR(curvature[i], 0.5, 0.12) << i;
  EXPECT_NEAR(curvature.mean(), 0.5, 0.01);
}

TEST(Curvature, OfALinearFunctionHasTheGradientAlongTheSurface) {
  Ball b = ball(9);
  for (Index i = 0; i < b.points.rows(); ++i) b.points.row(i).normalize();
  const Vector3 slope(1, -2, 0.5);
  const Points gradients = vertex_gradients(b.points, b.faces, b.points * slope);
  for (Index i = 0; i < b.points.rows(); ++i) {
    const Vector3 normal = b.points.row(i).transpose();
    const Vector3 expected = slope - slope.dot(normal) * normal;
    EXPECT_LE((gradients.row(i).transpose() - expected).norm(), 0.1) << i;
  }
}

}  // namespace
}  // namespace symsurf
