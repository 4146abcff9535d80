#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "fit/fitted.h"
#include "partial/partial_symmetries.h"

namespace symsurf {

namespace {

// Between the normals of an image and of its partner: those of a dozen noisy points differ by some
// 20 degrees.
constexpr double least_cosine = 0.8;

// A motion of a patch, or a similarity: turned and scaled about where it takes the patch's middle.
struct PatchMap {
  using Change = Eigen::Vector<double, 7>;  // a turn, a shift, a scale; all but the shift by lever

  Vector3 reflect(const Vector3& x) const { return map * x; }

  Eigen::Matrix<double, 3, 7> slopes(const Vector3& x) const {
    const Vector3 arm = map.linear() * (x - middle) / lever;
    Eigen::Matrix<double, 3, 7> slopes;
    slopes << 0, arm.z(), -arm.y(), 1, 0, 0, scales * arm.x(),  //
        -arm.z(), 0, arm.x(), 0, 1, 0, scales * arm.y(),        //
        arm.y(), -arm.x(), 0, 0, 0, 1, scales * arm.z();
    return slopes;
  }

  // What moves the images by a change.
  Eigen::Affine3d motion(const Change& by) const {
    constexpr double most = 0.2;  // radians
    const Vector3 turn = by.head<3>() / lever, pivot = map * middle;
    const double scale = std::clamp(1 + by[6] / lever, 0.8, 1.25);
    return Eigen::Translation3d(pivot + by.segment<3>(3)) *
           Eigen::AngleAxisd(std::min(turn.norm(), most), turn.stableNormalized()) *
           Eigen::Scaling(scale) * Eigen::Translation3d(-pivot);
  }

  std::pair<PatchMap, double> stepped(const Change& by) const {
    PatchMap next = *this;
    next.map = motion(by) * map;
    return {next, by.norm()};
  }
  void follow(const PatchMap& moved) { *this = moved; }
  static constexpr double ridge = 5e-5;  // what the patch leaves free stays as it is

  Eigen::Affine3d map;
  Vector3 middle;  // of the patch
  double lever;    // its extent
  bool scales;
};

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

double SurfaceFit::hold(const Eigen::Affine3d& map, const std::vector<Index>& points,
                        double tolerance, int slides) const {
  const auto agree = [&](const Eigen::Affine3d& other, Index i) {
    return landing(other, i, tolerance).agrees;
  };
  // Where a bar is as thick as one of the slides, its sides change places.
  std::vector<Eigen::Affine3d> there(slides), back(slides);
  Eigen::Affine3d slide = loosest(map, points, tolerance);
  for (int k = 0; k < slides; ++k, slide = slide * slide) {
    there[k] = slide * map;
    back[k] = slide.inverse() * map;
  }
  Index agreeing = 0;
  std::vector<Index> held(slides, 0);
  for (const Index i : points) {
    if (!agree(map, i)) continue;
    ++agreeing;
    for (int k = 0; k < slides; ++k)
      if (!agree(there[k], i) && !agree(back[k], i)) ++held[k];
  }
  const Index most = *std::max_element(held.begin(), held.end());
  return agreeing > 0 ? static_cast<double>(most) / static_cast<double>(agreeing) : 0;
}

namespace {

// What the images of some points of a surface find there.
struct LandingMatcher {
  const SurfaceFit& fit;
  const std::vector<Index>& points;
  double tolerance;

  double spacing() const { return fit.surface().spacing(); }

  std::vector<Match> matches(const std::vector<PatchMap>& maps, double /*limit*/) const {
    const SurfacePoints& all = fit.surface().points();
    std::vector<Match> found;
    for (const Index i : points) {
      const SurfaceFit::Landing landing = fit.landing(maps.front().map, i, tolerance);
      if (landing.agrees)
        found.push_back(
            {all.point(i), {}, all.point(landing.partner), {all.normal(landing.partner), 1}});
    }
    return found;
  }
};

// Distances from the partners' planes (Chen and Medioni 1992), within a tolerance that stays.
struct PlaneKernel {
  Counted operator()(const PatchMap&, const Match& match, const Vector3& off,
                     double tolerance) const {
    const Vector3& normal = match.partner_facet.normal;
    const double residual = std::abs(off.dot(normal)) / tolerance;
    return {Metric{0, 1, normal}, biweight(residual), residual};
  }
  double narrowed(double tolerance, const std::vector<Counted>& counted) const {
    return counted.empty() ? -1 : tolerance;
  }
};

PatchMap map_of(const SurfacePoints& all, const Eigen::Affine3d& map,
                const std::vector<Index>& points, bool scales) {
  const Vector3 middle = centroid(all, points);
  double squares = 0;
  for (const Index i : points) squares += (all.point(i) - middle).squaredNorm();
  return {map, middle, std::sqrt(squares / static_cast<double>(points.size())), scales};
}

}  // namespace

Eigen::Affine3d SurfaceFit::fitted(const Eigen::Affine3d& start, const std::vector<Index>& points,
                                   double tolerance, int steps) const {
  const PatchMap map = map_of(surface_.points(), start, points, scales_);
  if (!(map.lever > 0)) return start;
  return symsurf::fitted(map, LandingMatcher{*this, points, tolerance},
                         {tolerance, tolerance, steps}, PlaneKernel())
      .map;
}

// Slippage analysis (Gelfand and Guibas 2004).
Eigen::Affine3d SurfaceFit::loosest(const Eigen::Affine3d& map, const std::vector<Index>& points,
                                    double tolerance) const {
  const PatchMap posed = map_of(surface_.points(), map, points, false);
  if (!(posed.lever > 0)) return Eigen::Affine3d::Identity();
  GaussNewton<PatchMap> sum;
  const LandingMatcher matcher{*this, points, tolerance};
  for (const Match& match : matcher.matches({posed}, tolerance)) {
    const Counted one =
        PlaneKernel()(posed, match, posed.reflect(match.point) - match.partner, tolerance);
    sum.add(posed, match.point, Vector3::Zero(), one.metric, one.weight);
  }
  constexpr double far = 3;  // tolerances
  PatchMap::Change slide = PatchMap::Change::Zero();
  slide.head<6>() = far * tolerance *
                    eigen_of(Eigen::MatrixXd(sum.hessian().topLeftCorner<6, 6>())).vectors.col(0);
  return posed.motion(slide);
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
    plainer = plain(fitted(plainer, points, tolerance, 1), middle);
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
    pair.map = fit_.fitted(pair.map, seeds, width * tolerance_, 2);
  if (fit_.share(pair.map, seeds, tolerance_) < most_of_seeds) return {};
  constexpr int rounds = 8, last_steps = 4, slides = 2;
  for (int round = 0; round < rounds; ++round) {
    context.check();
    const std::size_t before = pair.from.size();
    pair.from = agreeing(pair.map, round == 0 ? seeds : pair.from);
    if (pair.from.empty()) return {};
    pair.map = fit_.fitted(pair.map, pair.from, tolerance_, 2);
    constexpr double grows = 1.02;
    if (static_cast<double>(pair.from.size()) < grows * static_cast<double>(before)) break;
  }
  if (static_cast<Index>(pair.from.size()) < least) return {};
  const Eigen::Affine3d last = fit_.fitted(pair.map, pair.from, tolerance_, last_steps);
  pair.hold = fit_.hold(last, pair.from, tolerance_, slides);
  pair.map = fit_.simplest(last, pair.from, tolerance_);
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
