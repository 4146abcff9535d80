#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/random.h"
#include "cloud/surface_points.h"
#include "point_group/symmetry_search.h"

namespace symsurf {

namespace {

constexpr Index sampled = 12'000;      // points
constexpr int draws = 300, drawn = 7;  // five normals decide; two more against noise
constexpr std::size_t most_refined = 16, most_tried = 3;
constexpr int steps = 10;
constexpr double farthest_off = 0.2;  // radians between a normal and the plane of the axis
constexpr double least_flatness = 0.3;
constexpr double least_radius = 0.02;  // diagonals
constexpr Index bins = 72;
// Of what is there, so that most images fall on it; far enough to show what they do not map.
constexpr std::array turns{-0.3, -0.2, 0.14, 0.25};
// The cells that a piece of the profile is a line in, diagonals: the first as wide as a guess may
// be off, the last as thin walls.
constexpr std::array cells{0.06, 0.04, 0.03, 0.02, 0.015, 0.01};
constexpr int steps_a_cell = 4;
constexpr Index least_in_cell = 6;

struct Line {
  Vector3 point = Vector3::Zero(), direction = Vector3::UnitZ();

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
    const Matrix3 inverse = (normals_ + ridge * normals_.trace() * Matrix3::Identity()).inverse();
    const SymmetricEigen<3> found =
        eigen_of(Matrix3(moments_ - mixed_ * inverse * mixed_.transpose()));
    const Vector3 direction = found.vectors.col(0);
    const Vector3 moment = -inverse * mixed_.transpose() * direction;
    return {direction.cross(moment), direction};
  }

 private:
  Matrix3 moments_ = Matrix3::Zero(), mixed_ = Matrix3::Zero(), normals_ = Matrix3::Zero();
};

struct OrientedPoint {
  Vector3 position, normal;

  struct Weight {
    double value, greatest;  // what the normal says of a line, and what it might say
  };
  Weight weight(const Line& line) const {
    const Vector3 radial = line.across(position);
    if (radial.norm() < least_radius) return {0, 0};
    const double off = normal.dot(line.direction.cross(radial.normalized()));
    const double flat = normal.cross(line.direction).norm();
    return {flat * biweight(std::abs(off) / farthest_off), flat};
  }
};

// A guess, and the share of what the normals might say of it that they say.
struct Guess {
  double support = 0;
  Line line;
};

double support_of(const std::vector<OrientedPoint>& patches, const Line& line) {
  double sum = 0, greatest = 0;
  for (const OrientedPoint& patch : patches) {
    const OrientedPoint::Weight weight = patch.weight(line);
    sum += weight.value;
    greatest += weight.greatest;
  }
  // Lines that hardly any normal says anything of, as one across a plate, are not supported.
  return sum / std::max(greatest, 0.3 * static_cast<double>(patches.size()));
}

// By weights, which what is off the line loses.
Line refined(const std::vector<OrientedPoint>& patches, Line line) {
  for (int step = 0; step < steps; ++step) {
    LineComplex complex;
    for (const OrientedPoint& patch : patches) {
      const double radius = std::max(line.across(patch.position).norm(), least_radius);
      complex.add(patch.position, patch.normal, patch.weight(line).value / (radius * radius));
    }
    line = complex.line();
  }
  return line;
}

// The best few that differ.
std::vector<Guess> guesses_of(const std::vector<OrientedPoint>& patches) {
  const auto count = static_cast<Index>(patches.size());
  if (count < drawn) return {};
  Random random(0);
  std::vector<Guess> guesses;
  const std::vector<OrientedPoint> some(patches.begin(),
                                        patches.begin() + std::min<Index>(count, 1000));
  for (int draw = 0; draw < draws; ++draw) {
    LineComplex complex;
    for (int k = 0; k < drawn; ++k) {
      const OrientedPoint& patch = patches[random.below(count)];
      complex.add(patch.position, patch.normal, 1);
    }
    const Line line = complex.line();
    guesses.push_back({support_of(some, line), line});
  }
  const auto better = [](const Guess& a, const Guess& b) { return a.support > b.support; };
  std::stable_sort(guesses.begin(), guesses.end(), better);
  guesses.resize(most_refined);
  for (Guess& guess : guesses) {
    guess.line = refined(some, guess.line);
    guess.support = support_of(some, guess.line);
  }
  std::stable_sort(guesses.begin(), guesses.end(), better);
  suppress_non_maxima(guesses, most_tried, [](const Guess& a, const Guess& b) {
    return are_parallel(a.line.direction, b.line.direction, same_direction);
  });
  return guesses;
}

// Moves the line to where the points, turned into one half plane about it, scatter least about
// pieces of a profile: Gauss-Newton steps, in each cell of the half plane on the distances from the
// line through its points, by robust weights.
class ProfileFit {
 public:
  explicit ProfileFit(const Points& points) : points_(points), weights_(points.rows(), 1.0) {}

  Line from(Line line) {
    line.point +=
        (points_.colwise().mean().transpose() - line.point).dot(line.direction) * line.direction;
    for (const double cell : cells)
      for (int step = 0; step < steps_a_cell; ++step)
        line = moved(line, cell, 0.5 * cell * (step % 2));
    return line;
  }

 private:
  using Vector4 = Eigen::Vector4d;

  Line moved(const Line& line, double cell, double shift) {
    const Eigen::Matrix<double, 3, 2> axes = orthogonal_to(line.direction);
    struct Turned {
      Eigen::Vector2d place;   // radius and height
      Eigen::Vector2d radial;  // unit, across the line
    };
    std::vector<Turned> turned;
    std::map<std::pair<int, int>, std::vector<Index>> members;
    for (Index i = 0; i < points_.rows(); ++i) {
      const Vector3 v = points_.row(i).transpose() - line.point;
      const Eigen::Vector2d flat = axes.transpose() * v;
      const Eigen::Vector2d place(flat.norm(), v.dot(line.direction));
      turned.push_back({place, flat / std::max(flat.norm(), 1e-9)});
      const Eigen::Vector2d at = ((place.array() + shift) / cell).floor();
      members[{static_cast<int>(at.x()), static_cast<int>(at.y())}].push_back(i);
    }
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Vector4 right = Vector4::Zero();
    std::vector<double> residuals(points_.rows(), infinity), sizes;
    for (const auto& [place, all] : members) {
      if (static_cast<Index>(all.size()) < least_in_cell) continue;
      double weight = 0;
      Eigen::Vector2d mean = Eigen::Vector2d::Zero();
      for (const Index i : all) {
        weight += weights_[i];
        mean += weights_[i] * turned[i].place;
      }
      if (!(weight > 1)) continue;
      mean /= weight;
      Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
      for (const Index i : all) {
        const Eigen::Vector2d off = turned[i].place - mean;
        scatter += weights_[i] * off * off.transpose();
      }
      const Eigen::Vector2d across = eigen_of(scatter).vectors.col(0);
      // Of a shift of the line along both axes, and of turns of its direction towards them.
      const auto change = [&](const Turned& t) {
        Vector4 row;
        row << -across.x() * t.radial,
            (across.y() * t.place.x() - across.x() * t.place.y()) * t.radial;
        return row;
      };
      Vector4 usual = Vector4::Zero();
      for (const Index i : all) usual += weights_[i] / weight * change(turned[i]);
      for (const Index i : all) {
        residuals[i] = across.dot(turned[i].place - mean);
        sizes.push_back(std::abs(residuals[i]));
        const Vector4 row = change(turned[i]) - usual;
        normal += weights_[i] * row * row.transpose();
        right -= weights_[i] * residuals[i] * row;
      }
    }
    if (sizes.empty()) return line;
    constexpr double deviations = 6;  // medians: four standard deviations of normal noise
    const double reach = std::max(deviations * median(std::move(sizes)), 1e-9);
    for (std::size_t i = 0; i < weights_.size(); ++i)
      weights_[i] = biweight(std::abs(residuals[i]) / reach);
    const Vector4 step = solved<4>(normal, right);
    Line next = line;
    next.point += axes * step.head<2>();
    next.direction = (line.direction + axes * step.tail<2>()).normalized();
    return next;
  }

  const Points& points_;
  std::vector<double> weights_;
};

// The share of the turn about the line where there is surface; what lies near the line, as the
// middle of a bottom does, is left out.
double share_of_turn(const Points& points, const Line& line) {
  constexpr double least_share = 0.5;  // of the radius that a tenth is beyond
  std::vector<double> radii;
  for (Index i = 0; i < points.rows(); ++i)
    radii.push_back(line.across(points.row(i).transpose()).norm());
  const double least = least_share * quantile(radii, 0.9);
  const Eigen::Matrix<double, 3, 2> axes = orthogonal_to(line.direction);
  std::array<bool, bins> there{};
  for (Index i = 0; i < points.rows(); ++i) {
    if (radii[i] < least) continue;
    const Eigen::Vector2d flat = axes.transpose() * (points.row(i).transpose() - line.point);
    const double turned = std::atan2(flat.y(), flat.x()) / (2 * std::numbers::pi) + 1;
    there[static_cast<std::size_t>(turned * bins) % bins] = true;
  }
  return static_cast<double>(std::count(there.begin(), there.end(), true)) / bins;
}

}  // namespace

std::optional<Revolution> find_revolution(const Cloud& cloud, const SymmetryTest& test,
                                          const Context& context) {
  const SurfacePoints samples(cloud.frame.to_frame(cloud.points, context), sampled, context);
  std::vector<OrientedPoint> patches;
  for (Index i = 0; i < test.coarse().size(); ++i)
    if (const Surfel& s = test.coarse()[i]; s.flatness > least_flatness)
      patches.push_back({s.mean, s.normal});
  std::optional<Revolution> best;
  for (const Guess& guess : guesses_of(patches)) {
    const Line line = ProfileFit(samples.points).from(guess.line);
    const double share = share_of_turn(samples.points, line);
    std::vector<Matrix3> elements;
    for (const double part : turns)
      elements.push_back(turn(Vector3::UnitZ(), 2 * std::numbers::pi * share * part));
    const auto passed = test.voted(GroupPose::along(line.direction, line.point), elements);
    if (passed && (!best || passed->vote.fit > best->axis.vote.fit))
      best = Revolution{{passed->pose, passed->vote, 0}, share};
  }
  return best;
}

}  // namespace symsurf
