#include "symmetries/partial/patch_growth.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/math.h"

namespace symsurf {

namespace {

using Vector7 = Eigen::Vector<double, 7>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;

// Between the normals of an image and of its partner: those of a dozen noisy points differ by some
// 20 degrees.
constexpr double least_cosine = 0.8;

// The motion of a turn about a pivot, times the extent, and a shift.
Eigen::Affine3d moved(const Eigen::Vector<double, 6>& by, double extent, const Vector3& pivot) {
  constexpr double most = 0.2;  // radians
  const Vector3 turn = by.head<3>() / extent;
  const double angle = std::min(turn.norm(), most);
  Eigen::Affine3d motion = Eigen::Affine3d::Identity();
  if (angle > 0) motion.linear() = Eigen::AngleAxisd(angle, turn.normalized()).toRotationMatrix();
  motion.translation() = pivot + by.tail<3>() - motion.linear() * pivot;
  return motion;
}

// How far along the surface the partner may lie, in spacings: beyond, the image is past a rim.
constexpr double past_rim = 1.3;

}  // namespace

PatchGrowth::PatchGrowth(const ThinnedSurface& surface, bool scales)
    : surface_(surface), scales_(scales), ceilings_(surface.size()) {
  const SurfacePoints& all = surface.points();
  for (Index i = 0; i < all.size(); ++i) {
    const Index other = all.neighbours(i, 0);
    const double off = (all.point(i) - all.point(other)).dot(all.normal(other));
    ceilings_[i] = biweight(std::abs(off) / surface.tolerance());
  }
}

double PatchGrowth::share(const Eigen::Affine3d& map, const std::vector<Index>& points,
                          double tolerance) const {
  const auto agrees = [&](Index i) { return landing(map, i, tolerance).agrees; };
  return static_cast<double>(std::count_if(points.begin(), points.end(), agrees)) /
         static_cast<double>(points.size());
}

PatchGrowth::Landing PatchGrowth::landing(const Eigen::Affine3d& map, Index i,
                                          double tolerance) const {
  const SurfacePoints& all = surface_.points();
  const Vector3 image = map * all.point(i);
  const double rim = past_rim * surface_.spacing();
  Landing landing{surface_.nearest(image)};
  if (landing.partner < 0) return landing;
  const Vector3 gap = image - all.point(landing.partner), normal = all.normal(landing.partner);
  landing.off = gap.dot(normal);
  const double along = std::sqrt(std::max(0.0, gap.squaredNorm() - landing.off * landing.off));
  const Vector3 turned = map.linear() * all.normal(i);
  landing.agrees = std::abs(landing.off) < tolerance && along < rim &&
                   std::abs(turned.dot(normal)) > least_cosine * turned.norm();
  return landing;
}

double PatchGrowth::hold(const Fit& fit, const std::vector<Index>& points,
                         double tolerance) const {
  const auto agree = [&](const Eigen::Affine3d& map, Index i) {
    return landing(map, i, tolerance).agrees;
  };
  std::array<Index, 3> held{};
  for (const Index i : points) {
    if (!agree(fit.map, i)) continue;
    ++held[0];
    Eigen::Affine3d there = fit.slide * fit.map, back = fit.slide.inverse() * fit.map;
    for (int k = 1; k < 3; ++k) {
      if (!agree(there, i) && !agree(back, i)) ++held[k];
      there = fit.slide * there;
      back = fit.slide.inverse() * back;
    }
  }
  return held[0] > 0 ? static_cast<double>(std::max(held[1], held[2])) / static_cast<double>(held[0])
                     : 0;
}

PatchGrowth::Fit PatchGrowth::fitted(const Eigen::Affine3d& start, const std::vector<Index>& points,
                                     double tolerance, int steps) const {
  const SurfacePoints& all = surface_.points();
  Fit fit{start};
  Vector3 mean = Vector3::Zero();
  for (const Index i : points) mean += all.point(i);
  mean /= static_cast<double>(points.size());
  double extent = 0;
  for (const Index i : points) extent += (all.point(i) - mean).squaredNorm();
  extent = std::sqrt(extent / static_cast<double>(points.size()));
  if (!(extent > 0)) return fit;
  for (int step = 0; step < steps; ++step) {
    const Vector3 pivot = fit.map * mean;
    Matrix7 products = Matrix7::Zero();
    Vector7 pull = Vector7::Zero();
    double weights = 0;
    for (const Index i : points) {
      const Landing landing = this->landing(fit.map, i, tolerance);
      if (!landing.agrees) continue;
      const double weight = biweight(std::abs(landing.off) / tolerance);
      const Vector3 normal = all.normal(landing.partner),
                    arm = (fit.map * all.point(i) - pivot) / extent;
      Vector7 by;
      by << arm.cross(normal), normal, scales_ ? arm.dot(normal) : 0.0;
      products += weight * by * by.transpose();
      pull += weight * landing.off * by;
      weights += weight;
    }
    if (!(weights > 0)) return {fit.map};
    products /= weights;
    pull /= weights;
    if (step + 1 == steps) {
      // Slippage analysis (Gelfand and Guibas 2004).
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> stiffness(
          products.topLeftCorner<6, 6>());
      constexpr double far = 3;  // tolerances
      fit.slide = moved(far * tolerance * stiffness.eigenvectors().col(0), extent, pivot);
    }
    // What the patch leaves free stays as it is.
    constexpr double ridge = 1e-4;
    products.diagonal().array() += ridge;
    const Vector7 move = -products.ldlt().solve(pull);
    Eigen::Affine3d change = moved(move.head<6>(), extent, pivot);
    const double scale = std::clamp(1 + move[6] / extent, 0.8, 1.25);
    change = change * Eigen::Translation3d(pivot) * Eigen::Scaling(scale) * Eigen::Translation3d(-pivot);
    fit.map = change * fit.map;
  }
  return fit;
}

// The points reached from the seeds over neighbours on which the map holds.
std::vector<Index> PatchGrowth::agreeing(const Eigen::Affine3d& map,
                                         const std::vector<Index>& seeds, double tolerance) const {
  const SurfacePoints& all = surface_.points();
  std::vector<char> seen(surface_.size(), 0);
  std::vector<Index> reached;
  const auto visit = [&](Index i) {
    if (seen[i]) return;
    seen[i] = 1;
    if (landing(map, i, tolerance).agrees) reached.push_back(i);
  };
  for (const Index i : seeds) visit(i);
  for (std::size_t k = 0; k < reached.size(); ++k)
    for (int n = 0; n < SurfacePoints::ring; ++n) visit(all.neighbours(reached[k], n));
  std::sort(reached.begin(), reached.end());
  return reached;
}

std::optional<PatchPair> PatchGrowth::grown(const Eigen::Affine3d& map,
                                            const std::vector<Index>& seeds, Index least,
                                            const Context& context) const {
  constexpr double wide = 4, most_of_seeds = 0.5;
  const double tolerance = surface_.tolerance();
  PatchPair pair;
  pair.map = map;
  for (const double width : {wide, 2.0, 1.5})
    pair.map = fitted(pair.map, seeds, width * tolerance, 2).map;
  const auto holds = [&](Index i) { return landing(pair.map, i, tolerance).agrees; };
  const auto held = std::count_if(seeds.begin(), seeds.end(), holds);
  if (static_cast<double>(held) < most_of_seeds * static_cast<double>(seeds.size())) return {};
  Eigen::Affine3d slide;
  constexpr int rounds = 8;
  for (int round = 0; round < rounds; ++round) {
    context.check();
    const std::size_t before = pair.from.size();
    pair.from = agreeing(pair.map, round == 0 ? seeds : pair.from, tolerance);
    if (pair.from.empty()) return {};
    const Fit fit = fitted(pair.map, pair.from, tolerance, 2);
    pair.map = fit.map;
    slide = fit.slide;
    constexpr double grows = 1.02;
    if (static_cast<double>(pair.from.size()) < grows * static_cast<double>(before)) break;
  }
  if (static_cast<Index>(pair.from.size()) < least) return {};
  pair.hold = hold({pair.map, slide}, pair.from, tolerance);
  double ceiling = 0;
  for (const Index i : pair.from) {
    const Landing landing = this->landing(pair.map, i, tolerance);
    if (landing.partner >= 0) pair.onto.push_back(landing.partner);
    if (landing.agrees) pair.score += biweight(std::abs(landing.off) / tolerance);
    ceiling += ceilings_[i];
  }
  pair.score = std::min(1.0, pair.score / std::max(ceiling, 1e-300));
  std::sort(pair.onto.begin(), pair.onto.end());
  pair.onto.erase(std::unique(pair.onto.begin(), pair.onto.end()), pair.onto.end());
  return pair;
}

}  // namespace symsurf
