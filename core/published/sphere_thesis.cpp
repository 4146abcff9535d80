#include <symsurf/context.h>
#include <symsurf/mirrors.h>
#include <symsurf/points.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/nelder_mead.h"
#include "base/parallel.h"
#include "pairing/matching.h"
#include "published.h"

namespace symsurf {

namespace {

constexpr Index most_points = 10'000;  // or a look at each of them, a thousand times, takes long

// x' = x + 2 (|u| - r) u / |u|, u = c - x, wherever x lies but at the centre.
bool mirrored(const Vector3& x, const Vector3& centre, double radius, Vector3& image) {
  const Vector3 u = centre - x;
  const double length = u.norm();
  image = x + 2 * (1 - radius / length) * u;
  return length > 0;
}

struct MeasuredSphere {
  Vector3 centre = Vector3::Zero();
  double radius = 0, measure = -1;
};

// Steps 1 to 4: of the spheres midway between each two points, of each radius, their centres on
// either side, the one of the greatest measure; equal measures: the first.
MeasuredSphere best_candidate(PointsView points, const std::vector<double>& radii,
                              const Context& context) {
  const double reach = measure_reach(points);
  const NearbyPoints nearby(points, reach);
  struct Image {
    Vector3 position;
    const std::vector<Vector3>* nearby;
  };
  // 0 where it is less than `least`: an image near the cloud adds no more than 1, others nothing.
  const auto measured = [&](const MeasuredSphere& sphere, double least,
                            std::vector<Image>& images) {
    images.clear();
    for (Index i = 0; i < points.size(); ++i) {
      Image image;
      if (!mirrored(points[i], sphere.centre, sphere.radius, image.position)) continue;
      image.nearby = nearby(image.position);
      if (image.nearby) images.push_back(image);
    }
    double sum = 0, rest = static_cast<double>(images.size());
    for (const Image& image : images) {
      if (sum + rest-- < least) return 0.0;
      double closest = reach * reach;
      for (const Vector3& x : *image.nearby)
        closest = std::min(closest, (x - image.position).squaredNorm());
      sum += wendland(std::sqrt(closest) / reach);
    }
    return sum;
  };
  std::vector<MeasuredSphere> found(
      points.size());  // the best of the pairs whose first point it is
  parallel_for(context, points.size(), 1, [&](Index i, Index) {
    std::vector<Image> images;
    for (Index j = i + 1; j < points.size(); ++j) {
      context.check();
      const Vector3 chord = points[i] - points[j];
      const double length = chord.norm();
      if (!(length > 0)) continue;
      for (const double side : {1.0, -1.0})
        for (const double radius : radii) {
          MeasuredSphere sphere{(points[i] + points[j]) / 2 + side * radius / length * chord,
                                radius};
          sphere.measure = measured(sphere, found[i].measure, images);
          if (sphere.measure > found[i].measure) found[i] = sphere;
        }
    }
  });
  return *std::max_element(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return a.measure < b.measure;  // the first of equal ones
  });
}

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
  const MeasuredSphere start = best_candidate(simplified, radii, context.stage(0, 0.8));

  const PointTree& tree = cloud.tree(context.stage(0.8, 0.8));
  const double reach = measure_reach(cloud.points);
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
        if (found.index >= 0) sum += wendland(std::sqrt(found.squared_distance) / reach);
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
  // Of images that fall on points, phi is 1 or a rounding error more.
  result.score = std::min(1.0, found / static_cast<double>(cloud.points.size()));
  add_pairs(result, cloud, values, context.stage(0.95, 1));
  result.statistics = {{"measure", found},
                       {"start_measure", start.measure},
                       {"start_centre", start.centre},
                       {"start_radius", start.radius},
                       {"candidates", simplified.rows() * (simplified.rows() - 1) *
                                          static_cast<Index>(radii.size())},
                       {"evaluations", static_cast<Index>(evaluations)}};
  if (cloud.points.size() > most_points)
    result.statistics["warning"] =
        std::to_string(cloud.points.size()) + " points given; sphere_thesis is for up to " +
        std::to_string(most_points) + ": the method sphere finds spheres of more, and sooner";
  return result;
}

}  // namespace

MethodImplementation sphere_thesis_method() {
  MethodImplementation method;
  method.name = "sphere_thesis";
  method.title = "Mirror sphere (thesis, Algorithm 4)";
  method.summary =
      "Tries spheres of several radii between all pairs of points of a downsampled cloud and "
      "refines the best by the Nelder-Mead simplex method.";
  method.parameters = {
      Parameter::real("min_radius_divisor", 5, 0.01, 1000, "",
                      "The least radius tried is the diagonal divided by this."),
      Parameter::real("max_radius_divisor", 3, 0.01, 1000, "",
                      "The greatest radius tried is the diagonal divided by this."),
      Parameter::integer("radii", 10, 1, 1000, "", "Number of radii tried, evenly spaced."),
      Parameter::integer("sample_size", 300, 10, 2000, "points",
                         "Minimum number of points after downsampling."),
      pair_distance(),
  };
  method.minimum_points = 5;
  method.preprocessing = Preprocessing::order_only();
  method.run = run_sphere_thesis;
  return method;
}

}  // namespace symsurf
