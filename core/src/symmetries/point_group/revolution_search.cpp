#include "symmetries/point_group/revolution_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "base/eigenvectors.h"
#include "base/math.h"
#include "base/random.h"

namespace symsurf {

namespace {

constexpr int draws = 300, drawn = 7;  // five normals decide; two more against noise
constexpr std::size_t most_refined = 8;
constexpr int steps = 10;
constexpr double farthest_off = 0.2;  // radians between a normal and the plane of the axis
constexpr double least_flatness = 0.3;
constexpr double least_radius = 0.02;  // diagonals
constexpr double least_support = 0.5;  // of the normals
// Of the mean square distance of normals from the axis, if it pointed another way.
constexpr double least_ratio = 8;
constexpr Index bins = 72;
constexpr std::array turns{-0.3, -0.17, 0.08, 0.23};  // of what is there, which most images hit

struct Line {
  Vector3 point = Vector3::Zero(), direction = Vector3::UnitZ();
  double ratio = 0;  // of the least mean square and the next

  Vector3 across(const Vector3& x) const {
    const Vector3 v = x - point;
    return v - v.dot(direction) * direction;
  }
};

// The line that the normals n at points x meet: d . (x × n) + m . n = 0 for its direction d and
// moment m.
class LineComplex {
 public:
  void add(const Vector3& x, const Vector3& normal, double weight) {
    const Vector3 moment = x.cross(normal);
    moments_ += weight * moment * moment.transpose();
    mixed_ += weight * moment * normal.transpose();
    normals_ += weight * normal * normal.transpose();
  }

  Line line() const {
    constexpr double ridge = 1e-6;  // where it may be shifted along itself, as of a cylinder
    const Matrix3 inverse =
        (normals_ + ridge * normals_.trace() * Matrix3::Identity()).inverse();
    const Matrix3 left = moments_ - mixed_ * inverse * mixed_.transpose();
    const SymmetricEigen<3> found = eigen_of(left);
    const Vector3 direction = found.vectors.col(0);
    const Vector3 moment = -inverse * mixed_.transpose() * direction;
    return {direction.cross(moment), direction,
            found.values[1] / std::max(found.values[0], 1e-12 * found.values[2])};
  }

 private:
  Matrix3 moments_ = Matrix3::Zero(), mixed_ = Matrix3::Zero(), normals_ = Matrix3::Zero();
};

struct Weight {
  double value = 0;     // what the normal says of the line
  double greatest = 0;  // what it might say
};

Weight weight_of(const Surfel& s, const Line& line) {
  const Vector3 radial = line.across(s.mean);
  const double along = s.normal.dot(line.direction), flat = std::sqrt(1 - std::min(1.0, along * along));
  if (radial.norm() < least_radius) return {};
  const double off = s.normal.dot(line.direction.cross(radial.normalized()));
  return {flat * biweight(std::abs(off) / farthest_off), flat};
}

double support_of(const std::vector<Surfel>& patches, const Line& line) {
  double sum = 0;
  for (const Surfel& s : patches) sum += weight_of(s, line).value;
  return sum;
}

// By weights that what is off the line loses.
Line refined(const std::vector<Surfel>& patches, Line line) {
  for (int step = 0; step < steps; ++step) {
    LineComplex complex;
    for (const Surfel& s : patches) {
      const double radius = std::max(line.across(s.mean).norm(), least_radius);
      complex.add(s.mean, s.normal, weight_of(s, line).value / (radius * radius));
    }
    line = complex.line();
  }
  return line;
}

// The share of the turn about the axis where there is surface, and the middle of that: what lies
// near the axis, as the middle of a bottom does, is left out.
double share_of_turn(const std::vector<Surfel>& patches, const Line& line) {
  constexpr double least_share = 0.5;  // of the radius that a tenth is beyond
  std::vector<double> radii;
  for (const Surfel& s : patches) radii.push_back(line.across(s.mean).norm());
  const double least = least_share * quantile(radii, 0.9);
  const Eigen::Matrix<double, 3, 2> axes = orthogonal_to(line.direction);
  std::array<bool, bins> there{};
  for (const Surfel& s : patches) {
    const Vector3 radial = line.across(s.mean);
    if (radial.norm() < least) continue;
    const double angle = std::atan2(axes.col(1).dot(radial), axes.col(0).dot(radial));
    const double turned = angle / (2 * std::numbers::pi) + 1;
    there[static_cast<std::size_t>(turned * bins) % bins] = true;
  }
  return static_cast<double>(std::count(there.begin(), there.end(), true)) / bins;
}

}  // namespace

std::optional<Revolution> find_revolution(const SymmetryTest& test) {
  std::vector<Surfel> patches;
  for (Index i = 0; i < test.coarse().size(); ++i)
    if (test.coarse()[i].flatness > least_flatness) patches.push_back(test.coarse()[i]);
  const auto count = static_cast<Index>(patches.size());
  if (count < drawn) return {};
  Random random(0);
  std::vector<std::pair<double, Line>> lines;
  for (int draw = 0; draw < draws; ++draw) {
    LineComplex complex;
    for (int k = 0; k < drawn; ++k) {
      const Surfel& s = patches[random.below(count)];
      complex.add(s.mean, s.normal, 1);
    }
    const Line line = complex.line();
    lines.emplace_back(support_of(patches, line), line);
  }
  std::stable_sort(lines.begin(), lines.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  lines.resize(most_refined);
  for (auto& [support, line] : lines) {
    line = refined(patches, line);
    support = support_of(patches, line);
  }
  const Line best = std::max_element(lines.begin(), lines.end(), [](const auto& a, const auto& b) {
                      return a.first < b.first;
                    })->second;
  Weight all;
  for (const Surfel& s : patches) {
    const Weight w = weight_of(s, best);
    all.value += w.value;
    all.greatest += w.greatest;
  }
  if (getenv("POTS")) fprintf(stderr, "rev: support %g ratio %g dir %g %g %g\n", all.value/all.greatest, best.ratio, best.direction[0], best.direction[1], best.direction[2]);
  if (!(all.value >= least_support * all.greatest) || !(best.ratio >= least_ratio)) return {};
  const double share = share_of_turn(patches, best);
  std::vector<Matrix3> elements;
  for (const double part : turns)
    elements.push_back(turn(Vector3::UnitZ(), 2 * std::numbers::pi * share * part));
  if (getenv("POTS")) {
    GroupPose p = GroupPose::along(best.direction, best.point);
    for (auto&e:elements) fprintf(stderr, "  glance %g", test.fit().support(p,e,glance_tolerance));
    fprintf(stderr, " share %g\n", share);
  }
  const auto passed = test.tried(GroupPose::along(best.direction, best.point), elements);
  if (getenv("POTS")) { if (passed) fprintf(stderr, "  passed support %g fit %g missing %g outliers %g\n", passed->vote.support, passed->vote.fit, passed->vote.missing, passed->vote.outliers); else fprintf(stderr,"  not passed\n"); }
  if (!passed) return {};
  return Revolution{{passed->pose, passed->vote, 0}, share};
}

}  // namespace symsurf
