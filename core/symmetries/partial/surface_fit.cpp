#include "partial/surface_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/linear_algebra.h"
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

// Of some points.
Vector3 centroid(const SurfacePoints& all, const std::vector<Index>& points) {
  Vector3 sum = Vector3::Zero();
  for (const Index i : points) sum += all.point(i);
  return sum / static_cast<double>(points.size());
}

// The translation or reflection that is next to a map and takes a point to the same image, but for
// what a glide shifts it along the plane.
Eigen::Affine3d plain(const Eigen::Affine3d& map, const Vector3& point) {
  const Vector3 image = map * point;
  Eigen::Affine3d near = Eigen::Affine3d::Identity();
  near.translation() = image - point;
  if (map.linear().determinant() > 0) return near;
  const Eigen::AngleAxisd turn(Matrix3(-map.linear()));  // by half a circle about the normal
  const Vector3& normal = turn.axis();
  near.linear() -= 2 * normal * normal.transpose();
  near.translation() = normal.dot(image + point) * normal;
  return near;
}

}  // namespace

SurfaceFit::Landing SurfaceFit::landing(const Eigen::Affine3d& map, Index i,
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

double SurfaceFit::share(const Eigen::Affine3d& map, const std::vector<Index>& points,
                         double tolerance) const {
  const auto agrees = [&](Index i) { return landing(map, i, tolerance).agrees; };
  return static_cast<double>(std::count_if(points.begin(), points.end(), agrees)) /
         static_cast<double>(points.size());
}

double SurfaceFit::hold(const Fit& fit, const std::vector<Index>& points, double tolerance,
                        int slides) const {
  const auto agree = [&](const Eigen::Affine3d& map, Index i) {
    return landing(map, i, tolerance).agrees;
  };
  // Where a bar is as thick as one of the slides, its sides change places.
  std::vector<Eigen::Affine3d> there(slides), back(slides);
  Eigen::Affine3d slide = fit.slide;
  for (int k = 0; k < slides; ++k, slide = slide * slide) {
    there[k] = slide * fit.map;
    back[k] = slide.inverse() * fit.map;
  }
  Index agreeing = 0;
  std::vector<Index> held(slides, 0);
  for (const Index i : points) {
    if (!agree(fit.map, i)) continue;
    ++agreeing;
    for (int k = 0; k < slides; ++k)
      if (!agree(there[k], i) && !agree(back[k], i)) ++held[k];
  }
  const Index most = *std::max_element(held.begin(), held.end());
  return agreeing > 0 ? static_cast<double>(most) / static_cast<double>(agreeing) : 0;
}

SurfaceFit::Fit SurfaceFit::fitted(const Eigen::Affine3d& start, const std::vector<Index>& points,
                                   double tolerance, int steps) const {
  const SurfacePoints& all = surface_.points();
  Fit fit{start};
  const Vector3 mean = centroid(all, points);
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
      const auto stiffness = eigen_of(Eigen::MatrixXd(products.topLeftCorner<6, 6>()));
      constexpr double far = 3;  // tolerances
      fit.slide = moved(far * tolerance * stiffness.vectors.col(0), extent, pivot);
    }
    // What the patch leaves free stays as it is.
    constexpr double ridge = 1e-4;
    products.diagonal().array() += ridge;
    const Vector7 move = -solved(products, pull);
    Eigen::Affine3d change = moved(move.head<6>(), extent, pivot);
    const double scale = std::clamp(1 + move[6] / extent, 0.8, 1.25);
    change =
        change * Eigen::Translation3d(pivot) * Eigen::Scaling(scale) * Eigen::Translation3d(-pivot);
    fit.map = change * fit.map;
  }
  return fit;
}

double SurfaceFit::mean_square(const Eigen::Affine3d& map, const std::vector<Index>& points,
                               double tolerance) const {
  double sum = 0;
  for (const Index i : points) {
    const Landing landing = this->landing(map, i, tolerance);
    const double off = landing.agrees ? landing.off : tolerance;
    sum += off * off;
  }
  return sum / static_cast<double>(points.size());
}

Eigen::Affine3d SurfaceFit::simplest(const Eigen::Affine3d& map, const std::vector<Index>& points,
                                     double tolerance) const {
  // Of the mean square: what the map is changed by is less than what images are off anyway.
  constexpr double as_well = 1.5, rounding = 1e-24;
  const Vector3 middle = centroid(surface_.points(), points);
  Eigen::Affine3d plainer = plain(map, middle);
  const auto is_near = [&] {
    double squares = 0;
    for (const Index i : points) {
      const Vector3 x = surface_.points().point(i);
      squares += (map * x - plainer * x).squaredNorm();
    }
    const double spacing = surface_.spacing();
    return squares < static_cast<double>(points.size()) * spacing * spacing;
  };
  for (int step = 0; step < 3 && is_near(); ++step)
    plainer = plain(fitted(plainer, points, tolerance, 1).map, middle);
  const bool fits = is_near() && mean_square(plainer, points, tolerance) <=
                                     as_well * mean_square(map, points, tolerance) + rounding;
  return fits ? plainer : map;
}

PatchGrowth::PatchGrowth(const SurfaceFit& fit)
    : fit_(fit), tolerance_(fit.surface().tolerance()), ceilings_(fit.surface().size()) {
  const SurfacePoints& all = fit.surface().points();
  for (Index i = 0; i < all.size(); ++i) {
    const Index other = all.neighbours(i, 0);
    const double off = (all.point(i) - all.point(other)).dot(all.normal(other));
    ceilings_[i] = biweight(std::abs(off) / tolerance_);
  }
}

// The points reached from the seeds over neighbours on which the map holds.
std::vector<Index> PatchGrowth::agreeing(const Eigen::Affine3d& map,
                                         const std::vector<Index>& seeds) const {
  const SurfacePoints& all = fit_.surface().points();
  std::vector<char> seen(all.size(), 0);
  std::vector<Index> reached;
  const auto visit = [&](Index i) {
    if (seen[i]) return;
    seen[i] = 1;
    if (fit_.landing(map, i, tolerance_).agrees) reached.push_back(i);
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
  PatchPair pair;
  pair.map = map;
  for (const double width : {wide, 2.0, 1.5})
    pair.map = fit_.fitted(pair.map, seeds, width * tolerance_, 2).map;
  if (fit_.share(pair.map, seeds, tolerance_) < most_of_seeds) return {};
  constexpr int rounds = 8, last_steps = 4, slides = 2;
  for (int round = 0; round < rounds; ++round) {
    context.check();
    const std::size_t before = pair.from.size();
    pair.from = agreeing(pair.map, round == 0 ? seeds : pair.from);
    if (pair.from.empty()) return {};
    pair.map = fit_.fitted(pair.map, pair.from, tolerance_, 2).map;
    constexpr double grows = 1.02;
    if (static_cast<double>(pair.from.size()) < grows * static_cast<double>(before)) break;
  }
  if (static_cast<Index>(pair.from.size()) < least) return {};
  const SurfaceFit::Fit last = fit_.fitted(pair.map, pair.from, tolerance_, last_steps);
  pair.hold = fit_.hold(last, pair.from, tolerance_, slides);
  pair.map = fit_.simplest(last.map, pair.from, tolerance_);
  score(pair);
  return pair;
}

// What the images come to the surface, of what the surface comes to itself (MirrorScore).
void PatchGrowth::score(PatchPair& pair) const {
  double ceiling = 0;
  for (const Index i : pair.from) {
    const SurfaceFit::Landing landing = fit_.landing(pair.map, i, tolerance_);
    if (landing.partner >= 0) pair.onto.push_back(landing.partner);
    if (landing.agrees) pair.score += biweight(std::abs(landing.off) / tolerance_);
    ceiling += ceilings_[i];
  }
  pair.score = ceiling > 0 ? std::min(1.0, pair.score / ceiling) : 0;
  std::sort(pair.onto.begin(), pair.onto.end());
  pair.onto.erase(std::unique(pair.onto.begin(), pair.onto.end()), pair.onto.end());
}

}  // namespace symsurf
