#include <symsurf/downsample.h>
#include <symsurf/errors.h>
#include <symsurf/sphere.h>

#include <atomic>
#include <cmath>

#include "base/nelder_mead.h"
#include "base/parallel.h"
#include "methods/registry.h"
#include "methods/thesis/nearest_cells.h"
#include "score/matching.h"
#include "score/symmetry_measure.h"

namespace symsurf {

namespace {

constexpr double support_of_alpha = 2.6;

// Where phi ends: alpha = 15 / l_avg of the set scored.
double support(PointsView points) {
  const Eigen::RowVector3d centroid = points.matrix().colwise().mean();
  const double average = (points.matrix().rowwise() - centroid).rowwise().norm().mean();
  return support_of_alpha * average / 15;
}

// x' = x + 2 (|u| - r) u / |u|, u = c - x, wherever x lies but at the centre.
bool mirrored(const Vector3& x, const Vector3& centre, double radius, Vector3& image) {
  const Vector3 u = centre - x;
  const double length = u.norm();
  image = x + 2 * (1 - radius / length) * u;
  return length > 0;
}

double phi(double squared, double support) {
  return squared < support * support ? wendland(std::sqrt(squared) / support) : 0;
}

struct Start {
  Vector3 centre = Vector3::Zero();
  double radius = 0, measure = -1;
};

/// Step 1 to 4 of Algorithm 4: a sphere midway between each two points, of each radius, its centre
/// on either side.
class CandidateSpheres {
 public:
  CandidateSpheres(PointsView points, const std::vector<double>& radii, const Context& context)
      : points_(points),
        radii_(radii),
        support_(support(points)),
        nearest_(points, support_, context) {
    for (Index cell = 0; cell < nearest_.cell_count(); ++cell)
      at_most_.push_back(phi(nearest_.least_squared(cell), support_));
  }

  Index count() const {
    return points_.size() * (points_.size() - 1) * static_cast<Index>(radii_.size());
  }

  /// Equal measures: the first.
  Start best(const Context& context) const {
    constexpr Index grain = 4;
    std::vector<Start> parts((points_.size() + grain - 1) / grain);
    std::atomic<double> greatest = -1;  // so far, in any thread: less is not worth measuring
    parallel_for(context, points_.size(), grain, [&](Index begin, Index end) {
      Start& best = parts[begin / grain];
      std::vector<Image> images(points_.size() + 1);
      for (Index i = begin; i < end; ++i)
        for (Index j = i + 1; j < points_.size(); ++j) {
          context.check();
          consider_pair(points_[i], points_[j], images, greatest, best);
        }
    });
    Start best;
    for (const Start& part : parts)
      if (part.measure > best.measure) best = part;
    return best;
  }

 private:
  struct Image {
    Vector3 place;
    Index cell;
  };

  void consider_pair(const Vector3& a, const Vector3& b, std::vector<Image>& images,
                     std::atomic<double>& greatest, Start& best) const {
    const Vector3 chord = a - b;
    const double length = chord.norm();
    if (!(length > 0)) return;
    for (const double side : {1.0, -1.0})
      for (const double radius : radii_) {
        const Vector3 centre = (a + b) / 2 + side * radius / length * chord;
        const double measure = measured(centre, radius, greatest, images);
        if (!(measure > best.measure)) continue;
        best = {centre, radius, measure};
        double before = greatest;
        while (measure > before && !greatest.compare_exchange_weak(before, measure)) continue;
      }
  }

  // Gives up where what cells allow at most cannot bring it above `least`.
  double measured(const Vector3& centre, double radius, double least,
                  std::vector<Image>& images) const {
    Index count = 0;
    double most = 1e-9 * static_cast<double>(points_.size());  // what rounding takes
    for (Index i = 0; i < points_.size(); ++i) {
      Image& image = images[count];
      mirrored(points_[i], centre, radius, image.place);
      image.cell = nearest_.cell(image.place);
      const double at_most = at_most_[image.cell];
      most += at_most;
      count += at_most > 0;
    }
    double sum = 0;
    for (Index i = 0; i < count; ++i) {
      if (most < least) return 0;
      const double part = phi(nearest_.squared(images[i].cell, images[i].place), support_);
      sum += part;
      most -= at_most_[images[i].cell] - part;
    }
    return sum;
  }

  PointsView points_;
  const std::vector<double>& radii_;
  double support_;
  NearestCells nearest_;
  std::vector<double> at_most_;  // of phi, anywhere in a cell
};

std::vector<double> tested_radii(double diagonal, const ParameterValues& values) {
  const double least = diagonal / values.real("min_radius_divisor");
  const double greatest = diagonal / values.real("max_radius_divisor");
  if (least > greatest)
    throw InvalidParameter(
        "min_radius_divisor is " + to_string(Value(values.real("min_radius_divisor"))) +
        ", below max_radius_divisor, " + to_string(Value(values.real("max_radius_divisor"))) +
        "; the diagonal over the first is the least radius");
  const Index count = values.integer("radii");
  std::vector<double> radii;
  for (Index k = 0; k < count; ++k)
    radii.push_back(count == 1 ? least
                               : least + (greatest - least) * static_cast<double>(k) /
                                             static_cast<double>(count - 1));
  return radii;
}

Result run_sphere_thesis(const Cloud& cloud, const ParameterValues& values,
                         const Context& context) {
  const std::vector<double> radii = tested_radii(cloud.diagonal, values);
  const Points simplified = downsample(cloud.points, values.integer("sample_size"), context);
  const CandidateSpheres candidates(simplified, radii, context);
  const Start start = candidates.best(context.stage(0, 0.8));

  PointTree tree(cloud.points, context.stage(0.8, 0.8));
  const double reach = support(cloud.points);
  const auto measure = [&](const Eigen::Vector4d& s) {
    constexpr Index grain = 1024;
    context.check();
    const Context silent(
        [&](double) {
          context.check();
          return true;
        },
        context.threads());
    return parallel_sum(silent, cloud.points.size(), grain, 0.0, [&](Index begin, Index end) {
      double sum = 0;
      for (Index p = begin; p < end; ++p) {
        Vector3 image;
        if (!mirrored(cloud.points[tree.order()[p]], s.head<3>(), s[3], image)) continue;
        const Neighbour found = tree.nearest(image, reach * reach);
        if (found.index >= 0) sum += phi(found.squared_distance, reach);
      }
      return sum;
    });
  };
  Eigen::Vector4d sphere;
  sphere << start.centre, start.radius;
  int evaluations = 1000;
  context.report(0.8);
  sphere =
      nelder_mead<4>(measure, sphere, 0.01 * cloud.diagonal, 1e-12 * cloud.diagonal, evaluations);
  context.report(0.95);

  Result result;
  result.method = "sphere_thesis";
  result.mirror = std::make_shared<Sphere>(sphere.head<3>(), std::abs(sphere[3]));
  const double found = measure(sphere);
  result.score = found / static_cast<double>(cloud.points.size());
  add_pairs(result, cloud.points, std::move(tree), *result.mirror,
            values.real("pair_distance") * cloud.diagonal, context.stage(0.95, 1));
  result.statistics = {{"measure", found},
                       {"start_measure", start.measure},
                       {"start_centre", start.centre},
                       {"start_radius", start.radius},
                       {"candidates", candidates.count()},
                       {"evaluations", static_cast<Index>(evaluations)}};
  return result;
}

}  // namespace

MethodImplementation sphere_thesis_method() {
  MethodImplementation method;
  method.name = "sphere_thesis";
  method.title = "Mirror sphere (thesis, Algorithm 4)";
  method.summary =
      "Tries spheres of given radii between all pairs of a thinned cloud and improves the best by "
      "Nelder and Mead's simplex.";
  method.parameters = {
      Parameter::real("min_radius_divisor", 5, 0.01, 1000, "",
                      "The diagonal is divided by this to give the least radius tried."),
      Parameter::real("max_radius_divisor", 3, 0.01, 1000, "",
                      "The diagonal is divided by this to give the greatest radius tried."),
      Parameter::integer("radii", 10, 1, 1000, "", "How many radii are tried, evenly spaced."),
      Parameter::integer("sample_size", 300, 10, 2000, "points",
                         "Points at the least that the cloud is thinned to."),
      Parameter::real("pair_distance", 0.05, 0, 1, "diagonal",
                      "A point whose image has no point of the cloud nearer than this has no "
                      "partner."),
  };
  method.minimum_points = 5;
  method.preprocessing = Preprocessing::none();
  method.run = run_sphere_thesis;
  return method;
}

}  // namespace symsurf
