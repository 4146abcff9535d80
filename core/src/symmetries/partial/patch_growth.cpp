#include "symmetries/partial/patch_growth.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/math.h"

namespace symsurf {

namespace {

using Vector7 = Eigen::Vector<double, 7>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;

// Between the normals of an image and of its partner: those of a dozen noisy points differ by some
// 20 degrees.
constexpr double least_cosine = 0.8;

// How far along the surface the partner may lie, in spacings: beyond, the image is past a rim.
constexpr double past_rim = 1.3;

}  // namespace

PatchGrowth::PatchGrowth(const ThinnedSurface& surface, bool scales)
    : surface_(surface), scales_(scales) {}

PatchGrowth::Landing PatchGrowth::landing(const Eigen::Affine3d& map, Index i,
                                          double tolerance) const {
  const SurfacePoints& all = surface_.points();
  const Vector3 image = map * all.point(i);
  const double rim = past_rim * surface_.spacing();
  const Neighbour nearest = all.tree.nearest(image, tolerance * tolerance + rim * rim);
  if (nearest.index < 0) return {};
  Landing landing{nearest.index};
  const Vector3 gap = image - all.point(nearest.index), normal = all.normal(nearest.index);
  landing.off = gap.dot(normal);
  const double along = std::sqrt(std::max(0.0, gap.squaredNorm() - landing.off * landing.off));
  const Vector3 turned = map.linear() * all.normal(i);
  landing.agrees = std::abs(landing.off) < tolerance && along < rim &&
                   std::abs(turned.dot(normal)) > least_cosine * turned.norm();
  return landing;
}

PatchGrowth::Fit PatchGrowth::fitted(const Eigen::Affine3d& start, const std::vector<Index>& points,
                                     double tolerance, int steps) const {
  const SurfacePoints& all = surface_.points();
  Fit fit{start, 0};
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
    if (!(weights > 0)) return {fit.map, 0};
    products /= weights;
    pull /= weights;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> stiffness(
        products.topLeftCorner<6, 6>(), Eigen::EigenvaluesOnly);
    fit.hold = std::max(0.0, stiffness.eigenvalues()[0]);
    // What the patch leaves free stays as it is.
    constexpr double ridge = 1e-4;
    products.diagonal().array() += ridge;
    const Vector7 move = -products.ldlt().solve(pull);
    const Vector3 turn = move.head<3>() / extent;
    const double angle = std::min(turn.norm(), 0.2), scale = 1 + move[6] / extent;
    Eigen::Affine3d change = Eigen::Affine3d::Identity();
    if (angle > 0) change.linear() = Eigen::AngleAxisd(angle, turn.normalized()).toRotationMatrix();
    change.linear() *= std::clamp(scale, 0.8, 1.25);
    change.translation() = pivot + move.segment<3>(3) - change.linear() * pivot;
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
  constexpr int rounds = 8;
  for (int round = 0; round < rounds; ++round) {
    context.check();
    const std::size_t before = pair.from.size();
    pair.from = agreeing(pair.map, round == 0 ? seeds : pair.from, tolerance);
    if (pair.from.empty()) return {};
    const Fit fit = fitted(pair.map, pair.from, tolerance, 2);
    pair.map = fit.map;
    pair.hold = fit.hold;
    constexpr double grows = 1.02;
    if (static_cast<double>(pair.from.size()) < grows * static_cast<double>(before)) break;
  }
  if (static_cast<Index>(pair.from.size()) < least) return {};
  for (const Index i : pair.from) {
    const Landing landing = this->landing(pair.map, i, tolerance);
    if (landing.partner >= 0) pair.onto.push_back(landing.partner);
    if (landing.agrees) pair.score += biweight(std::abs(landing.off) / tolerance);
  }
  pair.score /= static_cast<double>(pair.from.size());
  std::sort(pair.onto.begin(), pair.onto.end());
  pair.onto.erase(std::unique(pair.onto.begin(), pair.onto.end()), pair.onto.end());
  return pair;
}

}  // namespace symsurf
