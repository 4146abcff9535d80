#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "fit/fitted.h"
#include "fit/shapes.h"
#include "search/perpendicular.h"

namespace symsurf {

namespace {

constexpr double closest = 1e-9;  // diagonals: residuals below it are rounding

// Points on a mirror are their own images.
struct OwnImages {
  const std::vector<Vector3>& points;

  double spacing() const { return 1; }
  template <typename Map>
  std::vector<Match> matches(const std::vector<Map>&, double) const {
    const Facet none{Vector3::Zero(), 0};
    std::vector<Match> found;
    found.reserve(points.size());
    for (const Vector3& x : points) found.push_back({x, none, x, none});
    return found;
  }
};

// Residuals are Student's of 3 degrees, the tolerance their scale (Lange et al. 1989).
struct StudentKernel {
  template <typename Map>
  Counted operator()(const Map&, const Match&, const Vector3& off, double tolerance) const {
    if (!off.allFinite()) return {};
    const double r = off.norm() / tolerance;
    return {Metric{1, 0, Vector3::Zero()}, 4 / (3 + r * r), r};
  }

  double narrowed(double tolerance, const std::vector<Counted>& counted) const {
    double squares = 0;
    for (const Counted& one : counted) squares += one.weight * one.residual * one.residual;
    return counted.empty() ? -1
                           : tolerance * std::sqrt(squares / static_cast<double>(counted.size()));
  }
};

// The log-likelihood of distances from a mirror, its scale at the likeliest, less twice Schwarz's
// penalty for the mirror's numbers: noise is not Student's, and planes would be quadrics.
double nats(const Eigen::VectorXd& distances, double numbers) {
  constexpr int steps = 60;
  const auto count = static_cast<double>(distances.size());
  const Eigen::ArrayXd squares = distances.array().square();
  double scale = 1;
  for (int step = 0; step < steps; ++step)
    scale = std::max(closest, std::sqrt((4 * squares / (3 + squares / (scale * scale))).mean()));
  return -count * std::log(scale) - 2 * (squares / (3 * scale * scale)).log1p().sum() -
         numbers * std::log(count);
}

// The points in the frame of a search, which has some of them with their normals. Of a large cloud
// both have some.
struct PointsOfMirror {
  perpendicular::SearchCloud search;
  std::vector<Vector3> all;

  Eigen::VectorXd distances(const Mirror& mirror) const {
    Eigen::VectorXd distances(static_cast<Index>(all.size()));
    for (Index i = 0; i < distances.size(); ++i) {
      const std::optional<Foot> foot = mirror.at(all[i]);
      distances[i] = foot ? foot->distance : 1;
    }
    return distances;
  }

  template <typename Shape>
  Shape fitted_through(const Shape& start) const {
    constexpr Schedule schedule{1, closest, 60, 1e-15};
    return fitted(start, OwnImages{all}, schedule, StudentKernel{});
  }
};

std::shared_ptr<Mirror> plane_of(const PointsOfMirror& points) {
  const UnitPlane plane = points.fitted_through(UnitPlane{Vector3::UnitZ(), 0});
  return std::make_shared<Plane>(plane.normal, plane.offset);
}

// By algebraic least squares, then geometrically.
std::shared_ptr<Mirror> sphere_of(const PointsOfMirror& points) {
  constexpr double flattest = 1e-6;  // diagonals, one over the radius
  const Eigen::Vector4d round = sphere_through(rows_of(points.all));
  std::vector<UnitSphere> starts{{Vector3::Zero(), Vector3::UnitZ(), 0}};
  if (round.allFinite() && round[3] > 0)
    starts.push_back(
        {round.head<3>() + round[3] * Vector3::UnitX(), Vector3::UnitX(), 1 / round[3]});
  UnitSphere best;
  double most = -infinity;
  for (const UnitSphere& start : starts) {
    const UnitSphere sphere = points.fitted_through(start);
    Eigen::VectorXd distances(static_cast<Index>(points.all.size()));
    for (Index i = 0; i < distances.size(); ++i) distances[i] = sphere.distance(points.all[i]);
    const double fits = nats(distances, 0);
    if (fits > most) std::tie(best, most) = std::pair(sphere, fits);
  }
  if (!(std::abs(best.curvature) > flattest)) return nullptr;
  return std::make_shared<Sphere>(best.centre(), best.radius());
}

std::optional<GeneralQuadric> quadric_near(const PointsOfMirror& points) {
  const perpendicular::SearchCloud& some = points.search;
  std::vector<std::pair<Vector3, Vector3>> oriented;
  for (Index i = 0; i < some.size(); ++i) oriented.emplace_back(some.point(i), some.normal(i));
  return GeneralQuadric::nearest_to(oriented);
}

// Across an axis a cylinder is a circle. The axes tried are the principal ones, the one that the
// normals lie across and the one along which the quadric bends least.
std::shared_ptr<Mirror> cylinder_of(const PointsOfMirror& points) {
  std::vector<Vector3> axes{Vector3::UnitX(), Vector3::UnitY(), Vector3::UnitZ()};
  axes.emplace_back(eigen_of_scatter(points.search.normals).vectors.col(0));
  if (const auto quadric = quadric_near(points)) {
    const SymmetricEigen<3> bends = eigen_of(quadric->quadric.matrix());
    Index least;
    bends.values.cwiseAbs().minCoeff(&least);
    axes.emplace_back(bends.vectors.col(least));
  }
  const Points all = rows_of(points.all);
  std::shared_ptr<Mirror> best;
  double most = -infinity;
  for (const Vector3& axis : axes) {
    Eigen::Matrix<double, 3, 2> sides;
    sides << across(axis, 0), across(axis, 1);
    const Vector3 round = sphere_through(all * sides);
    if (!round.allFinite() || !(round[2] > 0)) continue;
    const UnitCylinder found =
        points.fitted_through(UnitCylinder{sides * round.head<2>(), axis, round[2]});
    if (!(found.radius < 1 / single_rounding)) continue;
    const auto mirror = std::make_shared<Cylinder>(found.point, found.axis, found.radius);
    const double fits = nats(points.distances(*mirror), 0);
    if (fits > most) std::tie(best, most) = std::pair(mirror, fits);
  }
  return best;
}

// Through noise a pair of sheets comes closer than one: points are then on either side of it.
bool is_one_sheet(const Quadric& quadric, const perpendicular::SearchCloud& some) {
  constexpr double on_one_side = 0.9;
  double ahead = 0, behind = 0;
  for (Index i = 0; i < some.size(); ++i)
    if (const std::optional<Foot> foot = quadric.at(some.point(i)))
      (foot->normal.dot(some.normal(i)) > 0 ? ahead : behind) += 1;
  return std::max(ahead, behind) > on_one_side * (ahead + behind);
}

std::shared_ptr<Mirror> quadric_of(const PointsOfMirror& points) {
  const std::optional<GeneralQuadric> start = quadric_near(points);
  if (!start) return nullptr;
  const Quadric fitted = points.fitted_through(*start).quadric;
  return std::make_shared<Quadric>(is_one_sheet(fitted, points.search) ? fitted : start->quadric);
}

std::shared_ptr<Mirror> free_form_of(const PointsOfMirror& points) {
  return perpendicular::surface_through(points.search);
}

struct KindThrough {
  std::string_view name;
  double numbers;
  std::shared_ptr<Mirror> (*through)(const PointsOfMirror&);
};

constexpr std::array kinds{KindThrough{"plane", 3, plane_of}, KindThrough{"sphere", 4, sphere_of},
                           KindThrough{"cylinder", 5, cylinder_of},
                           KindThrough{"quadric", 9, quadric_of},
                           KindThrough{"free-form", 12, free_form_of}};

// Six a patch, each of which as many points hold as are around it.
double numbers_of(const KindThrough& kind, const PointsOfMirror& points) {
  if (kind.through != free_form_of) return kind.numbers;
  return 6 * static_cast<double>(points.search.size()) /
         static_cast<double>(perpendicular::points_a_patch(points.search));
}

const KindThrough* asked(std::string_view name, bool has_direction) {
  if (name == "auto") return nullptr;
  std::string allowed = "auto";
  for (const KindThrough& kind : kinds) {
    const bool takes = !has_direction || kind.name == "plane" || kind.name == "free-form";
    if (takes && kind.name == name) return &kind;
    if (takes) allowed += ", " + std::string(kind.name);
  }
  throw InvalidParameter("kind is '" + std::string(name) + "'; allowed is " + allowed +
                         (has_direction ? " with a direction" : ""));
}

// Along a direction: an oblique plane, or heights over one.
std::shared_ptr<Mirror> along(const Vector3& direction, const Mirror& found, PointsView points,
                              const Context& context) {
  if (found.kind() == "plane") {
    const Foot foot = *found.at(Vector3::Zero());
    return std::make_shared<ObliquePlane>(foot.normal, foot.distance, direction);
  }
  Points feet(points.size(), 3);
  for (Index i = 0; i < points.size(); ++i) {
    const std::optional<Foot> foot = found.at(points[i]);
    feet.row(i) = (foot ? foot->point : points[i]).transpose();
  }
  return std::make_shared<HeightField>(direction, std::move(feet), context);
}

}  // namespace

std::shared_ptr<Mirror> fit_mirror(PointsView points, std::string_view kind,
                                   const std::optional<Vector3>& direction,
                                   const Context& context) {
  constexpr Index searched = 4000;
  constexpr Index most_fitted = 20000;  // points: more hold the numbers of no mirror better
  const KindThrough* only = asked(kind, direction.has_value());
  const auto least = static_cast<Index>(only ? only->numbers : kinds.front().numbers);
  const Cloud cloud = checked_cloud(points, {}, least, context.stage(0, 0.1));
  PointsOfMirror given{{cloud, searched, context.stage(0.1, 0.4)}, {}};
  if (given.search.noisy()) given.search.smooth(context.stage(0.4, 0.6));
  perpendicular::orient(given.search);
  const PointsView some = cloud.thinned(most_fitted, context.stage(0.6, 0.6)).points;
  for (Index i = 0; i < some.size(); ++i)
    given.all.emplace_back(given.search.axes.transpose() * (some[i] - given.search.centroid) /
                           given.search.diagonal);
  std::shared_ptr<Mirror> best;
  double most = -infinity;
  for (const KindThrough& one : kinds) {
    context.check();
    if (only && &one != only) continue;
    if (direction && one.through != plane_of && one.through != free_form_of) continue;
    // Twice as many points as numbers tell which kind they are of.
    if (!only && best && static_cast<double>(points.size()) < 2 * one.numbers) continue;
    const std::shared_ptr<Mirror> mirror = one.through(given);
    if (!mirror) continue;
    const double fits = nats(given.distances(*mirror), numbers_of(one, given));
    if (!best || fits > most) std::tie(best, most) = std::pair(mirror, fits);
  }
  if (!best)
    throw InvalidInput("the " + std::to_string(points.size()) + " points determine no " +
                       std::string(only ? only->name : "mirror"));
  best = perpendicular::in_input_units(*best, given.search);
  if (direction) best = along(*direction, *best, points, context.stage(0.9, 1));
  best->set_footprint(std::make_shared<Points>(points.matrix()));
  return best;
}

}  // namespace symsurf
