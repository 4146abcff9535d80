#include "homologous/homologous_points.h"

#include <gtest/gtest.h>
#include <symsurf/mirrors.h>
#include <symsurf/operations.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include "base/math.h"
#include "bumpy_ball.h"
#include "cloud/cloud.h"
#include "expect_error.h"
#include "figure.h"
#include "random_cloud.h"

namespace symsurf::homologous_points_tests {
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
  for (std::uint64_t seed = 0; seed < draws(4); ++seed)
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

// Both sides of a ball's half with x > 0, whose rims are drawn to the midline.
Ball two_halves(std::uint64_t seed) {
  const Ball whole = ball(seed);
  std::vector<std::array<Index, 3>> faces;
  std::vector<Vector3> points;
  std::map<std::pair<Index, int>, Index> number;
  const auto of = [&](Index i, int side) {
    Vector3 x = whole.points.row(i).transpose();
    if (std::abs(x.x()) <= 0.09 * std::hypot(x.x(), x.y())) x.x() = side = 0;
    const auto [at, is_new] = number.try_emplace({i, side}, static_cast<Index>(points.size()));
    if (is_new) points.push_back(Vector3(side < 0 ? -x.x() : x.x(), x.y(), x.z()));
    return at->second;
  };
  for (const auto& face : whole.faces.rowwise()) {
    if (std::any_of(face.begin(), face.end(), [&](Index i) { return whole.points(i, 0) < 0; }))
      continue;
    faces.push_back({of(face[0], 1), of(face[1], 1), of(face[2], 1)});
    faces.push_back({of(face[1], -1), of(face[0], -1), of(face[2], -1)});
  }
  Ball b{Points(static_cast<Index>(points.size()), 3),
         Triangles(static_cast<Index>(faces.size()), 3),
         {}};
  for (Index i = 0; i < b.points.rows(); ++i) b.points.row(i) = points[i].transpose();
  for (Index f = 0; f < b.faces.rows(); ++f)
    b.faces.row(f) << faces[f][0], faces[f][1], faces[f][2];
  return b;
}

Ball octahedron() {
  Ball b{Points(6, 3), Triangles(8, 3), {}};
  b.points << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
  for (int f = 0; f < 8; ++f) {
    const bool turned = (f ^ f >> 1 ^ f >> 2) & 1;
    b.faces.row(f) << f % 2, turned ? 4 + f / 4 : 2 + f / 2 % 2, turned ? 2 + f / 2 % 2 : 4 + f / 4;
  }
  return b;
}

// Each face in four.
Ball subdivided(const Ball& coarse) {
  std::map<std::pair<Index, Index>, Index> middle_of;
  std::vector<std::array<Index, 3>> faces;
  for (const auto& face : coarse.faces.rowwise()) {
    std::array<Index, 3> m;
    for (int c = 0; c < 3; ++c)
      m[c] = middle_of
                 .try_emplace(std::minmax(face[c], face[(c + 1) % 3]),
                              coarse.points.rows() + static_cast<Index>(middle_of.size()))
                 .first->second;
    for (int c = 0; c < 3; ++c) faces.push_back({face[c], m[c], m[(c + 2) % 3]});
    faces.push_back(m);
  }
  Ball fine{Points(coarse.points.rows() + static_cast<Index>(middle_of.size()), 3),
            Triangles(static_cast<Index>(faces.size()), 3),
            {}};
  fine.points.topRows(coarse.points.rows()) = coarse.points;
  for (const auto& [ends, i] : middle_of)
    fine.points.row(i) =
        (coarse.points.row(ends.first) + coarse.points.row(ends.second)).normalized();
  for (Index f = 0; f < fine.faces.rows(); ++f)
    fine.faces.row(f) << faces[f][0], faces[f][1], faces[f][2];
  return fine;
}

// Gives the body's shape to a ball, leaves the faces whose centres on the ball are kept, and finds
// the partners among all points.
Ball body_of(Ball b, const std::function<bool(const Vector3&)>& keeps) {
  std::vector<Index> kept;
  for (Index f = 0; f < b.faces.rows(); ++f) {
    Vector3 centre = Vector3::Zero();
    for (const Index i : b.faces.row(f)) centre += b.points.row(i).normalized().transpose() / 3;
    if (keeps(centre)) kept.push_back(f);
  }
  b.faces = Triangles(b.faces(kept, Eigen::indexing::all));
  for (Index i = 0; i < b.points.rows(); ++i)
    b.points.row(i) = on_body(b.points.row(i).normalized().transpose()).transpose();
  b.partner.resize(b.points.rows());
  for (Index i = 0; i < b.points.rows(); ++i) {
    const Eigen::RowVector3d image = b.points.row(i) * Vector3(-1, 1, 1).asDiagonal();
    (b.points.rowwise() - image).rowwise().squaredNorm().minCoeff(&b.partner[i]);
  }
  return b;
}

// How many vertices of faces, of those that count, are not mapped to their partners.
Index wrong_partners(const Ball& body, std::uint64_t seed, bool bent,
                     const std::function<bool(const Vector3&)>& counts) {
  const double diagonal = diagonal_of(body.points);
  const Deformed d = deformed(body, SideMap(seed, 2 * share_of_diagonal * diagonal), bent);
  Values values = homologous;
  values["max_angle"] = 90.0;
  const OperationResult pairs =
      operate("correspondences", {d.points, d.faces}, mirror_of(bent), values);
  std::vector<bool> is_wrong(d.points.rows(), false);
  for (const auto& face : body.faces.rowwise())
    for (const Index i : face)
      is_wrong[i] = counts(body.points.row(i).normalized().transpose()) &&
                    pairs.arrays.at("index")(i, 0) != static_cast<double>(body.partner[i]);
  return std::count(is_wrong.begin(), is_wrong.end(), true);
}

bool everywhere(const Vector3&) { return true; }

TEST(HomologousPoints, OfASymmetricTriangulationAreItsVerticesToTheLast) {
  const std::pair<const char*, bool (*)(const Vector3&)> parts[]{
      {"whole", everywhere},
      {"face", [](const Vector3& u) { return u.y() > -0.3; }},
      {"two that mirror each other", [](const Vector3& u) { return std::abs(u.x()) > 0.15; }},
      {"two that mirror themselves", [](const Vector3& u) { return std::abs(u.z()) > 0.15; }},
      {"three", [](const Vector3& u) { return std::abs(std::abs(u.x()) - 0.4) > 0.1; }}};
  const Ball lattice = subdivided(subdivided(subdivided(subdivided(subdivided(octahedron())))));
  for (std::uint64_t seed = 60; seed < 60 + draws(2); ++seed) {
    bool bent = seed % 2 == 1;
    for (const auto& [name, keeps] : parts) {
      const Ball irregular = body_of(subdivided(two_halves(seed)), keeps);
      EXPECT_EQ(wrong_partners(irregular, seed, bent, everywhere), 0) << seed << name;
      EXPECT_EQ(wrong_partners(body_of(lattice, keeps), seed, bent, everywhere), 0) << seed << name;
      bent = !bent;
    }
  }
}

// All but for what mirrors a hole.
TEST(HomologousPoints, OfATriangulationWithAHoleOnOneSideAreItsVertices) {
  const Ball lattice = subdivided(subdivided(subdivided(subdivided(subdivided(octahedron())))));
  const Vector3 hole = Vector3(0.8, 0.6, 0);
  const auto has_face = [&](const Vector3& u) { return u.dot(hole) < 0.85; };
  const auto counts = [&](const Vector3& u) {
    return Vector3(std::abs(u.x()), u.y(), u.z()).dot(hole) < 0.8;
  };
  for (std::uint64_t seed = 70; seed < 70 + draws(3); ++seed) {
    EXPECT_EQ(wrong_partners(body_of(subdivided(two_halves(seed)), has_face), seed, false, counts),
              0);
    EXPECT_EQ(wrong_partners(body_of(lattice, has_face), seed, false, counts), 0);
  }
}

// But for the diagonals of its quadrangles, which are drawn on both sides apart.
TEST(HomologousPoints, OfOneTriangulationAreItsVertices) {
  for (std::uint64_t seed = 0; seed < draws(2); ++seed)
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
  for (std::uint64_t seed = 0; seed < draws(2); ++seed)
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
  for (std::uint64_t seed = 0; seed < draws(3); ++seed) {
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

TEST(HomologousPoints, LieOnTheImageOfTheirFaces) {
  const Ball body = resampled_body(4);
  const Deformed d = deformed(body, SideMap(4, 0.05), false);
  const OperationResult result = operate("asymmetry", {d.points, d.faces}, middle, homologous);
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

// Root mean squares over the matched points.
struct Sureness {
  double error_over_deviation, length_over_truth;
};

Sureness sureness(const OperationResult& result, const Deformed& truth) {
  double errors = 0, lengths = 0, true_lengths = 0, count = 0;
  for (Index i = 0; i < truth.points.rows(); ++i) {
    const Eigen::RowVector3d vector = result.arrays.at("vector").row(i),
                             expected = truth.places.row(i) - truth.points.row(i);
    if (!vector.allFinite()) continue;
    ++count;
    errors += (vector - expected).squaredNorm() / std::pow(result.arrays.at("vector_sd")(i, 0), 2);
    lengths += vector.squaredNorm();
    true_lengths += expected.squaredNorm();
  }
  return {std::sqrt(errors / count), std::sqrt(lengths / true_lengths)};
}

TEST(HomologousPoints, SayHowSureTheyAre) {
  for (std::uint64_t seed = 0; seed < draws(3); ++seed)
    for (const bool has_relief : {true, false}) {
      Ball body = resampled_body(seed);
      if (!has_relief)
        for (Index i = 0; i < body.points.rows(); ++i) body.points.row(i).normalize();
      const double amplitude = share_of_diagonal * diagonal_of(body.points);
      const Deformed d = deformed(body, SideMap(seed, amplitude), false);
      const OperationResult result = operate("asymmetry", {d.points, d.faces}, middle, homologous);
      const auto [error, length] = sureness(result, d);
      EXPECT_LE(error, 1.4) << seed << has_relief;
      EXPECT_LE(length, 1.1) << seed << has_relief;
      EXPECT_EQ(result.statistics.count("warning"), has_relief ? 0 : 1)
          << figure(result, "known_share");
      EXPECT_EQ(figure(result, "known_share") > 0.5, has_relief);
      EXPECT_GT(figure(result, "detectable_tangential"), 0);
      const Eigen::MatrixXd& known = result.arrays.at("known");
      for (Index i = 0; i < d.points.rows(); ++i)
        if (result.arrays.at("matched")(i, 0) == 1) {
          EXPECT_EQ(result.arrays.at("confidence")(i, 0), known(i, 0));
          EXPECT_TRUE(known(i, 0) >= 0 && known(i, 0) <= 1);
        }
    }
}

TEST(HomologousPoints, FollowLandmarksAsFarAsTheseAreCertain) {
  Ball body = resampled_body(0);
  for (Index i = 0; i < body.points.rows(); ++i) body.points.row(i).normalize();
  const double diagonal = diagonal_of(body.points);
  const Deformed d = deformed(body, SideMap(0, share_of_diagonal * diagonal), false);
  OperationInput input{d.points, d.faces};
  const double without = median_error(operate("asymmetry", input, middle, homologous), d);
  constexpr Index pairs = 40;
  input.landmark_pairs = Eigen::MatrixXd::Zero(pairs, 7);
  for (Index k = 0; k < pairs; ++k) {
    const Index i = k * d.points.rows() / pairs;
    input.landmark_pairs.row(k).head(3) = d.points.row(i);
    input.landmark_pairs.row(k).segment(3, 3) =
        middle.reflect(Vector3(d.places.row(i).transpose())).transpose();
  }
  EXPECT_LT(median_error(operate("asymmetry", input, middle, homologous), d), 0.7 * without);
  input.landmark_pairs.col(6).setConstant(1e3 * diagonal);
  EXPECT_NEAR(median_error(operate("asymmetry", input, middle, homologous), d), without,
              1e-3 * without);
  expect_error<InvalidInput>("they need the pairing homologous",
                             [&] { operate("asymmetry", input, middle); });
  expect_error<InvalidInput>("they need the pairing homologous",
                             [&] { operate("align", input, middle); });
  input.landmark_pairs(0, 6) = -1;
  expect_error<InvalidInput>("standard deviation, 0 or more",
                             [&] { operate("asymmetry", input, middle, homologous); });
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

}  // namespace
}  // namespace symsurf::homologous_points_tests
