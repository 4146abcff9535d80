#include "detection/run_alone.h"

#include <algorithm>
#include <optional>

#include "cloud/cloud.h"
#include "cloud/outline.h"
#include "preprocess/nonfinite_removal.h"
#include "preprocess/places.h"
#include "preprocess/run_on.h"
#include "preprocess/skin.h"
#include "preprocess/strays.h"
#include "preprocess/surface_samples.h"

namespace symsurf {

namespace {

// Points that faces use are strays only where these are hardly any of the surface: as little of its
// area as Strays takes for a part of the points.
bool hold_surface(const Strays& strays, const Cloud& cloud, TrianglesView faces) {
  constexpr double notable = 0.05;
  const Points rest = strays.rows(cloud.points);
  const double left = surface_area(rest, strays.faces(faces, cloud.points.size()));
  return left < (1 - notable) * surface_area(cloud.points, faces);
}

// The pipeline of one process, from finite points on.
class Pipeline {
 public:
  Pipeline(std::uint64_t seed, const Method& method, const ParameterValues& values,
           const Context& context)
      : seed_(seed), method_(method), values_(values), context_(context) {}

  Result run(PointsView points, PointsView normals, TrianglesView faces) const {
    const Index least = faces.empty() ? method_.minimum_points : 1;
    const Cloud cloud = checked(points, normals, least);
    context_.report(0);
    auto strays = Strays::where_any(cloud, method_, unreported_);
    if (strays && !faces.empty() && hold_surface(*strays, cloud, faces)) strays.reset();
    if (!strays) return run_on_surface(cloud, faces);
    const Triangles rest = strays->faces(faces, points.size());
    return run_on(*strays, cloud, least, context_,
                  [&](const Cloud& cloud) { return run_on_surface(cloud, rest); });
  }

 private:
  Cloud checked(PointsView points, PointsView normals, Index least) const {
    Cloud cloud = checked_cloud(points, normals, least, unreported_);
    cloud.seed = seed_;
    return cloud;
  }

  Result run_on_surface(const Cloud& cloud, TrianglesView faces) const {
    const auto samples = SurfaceSamples::where_coarse(cloud, faces, values_, unreported_);
    if (!samples) {
      require_count(cloud.points.size(), method_.minimum_points);
      return run_on_places(cloud);
    }
    Cloud sampled = checked(samples->points(), samples->normals(), method_.minimum_points);
    sampled.vertices = cloud.points;
    Result result = run_on_places(sampled);
    samples->map_back(result);
    return result;
  }

  Result run_on_places(const Cloud& cloud) const {
    std::optional<Places> places;
    if (!method_.sees_copies) places = Places::where_copied(cloud.points, unreported_);
    const auto run = [&](const Cloud& cloud) { return run_on_skin(cloud); };
    Result result = places && places->size() >= method_.minimum_points
                        ? run_on(*places, cloud, method_.minimum_points, context_, run)
                        : run(cloud);
    set_footprint(result, outline(cloud.points, context_));
    return result;
  }

  // Of a mirror beyond chance what is inside may tell more: an exact partner of each point.
  Result run_on_skin(const Cloud& cloud) const {
    constexpr double by_chance = 0.4;
    constexpr Index few = 20000;
    const auto run = [&](const Cloud& cloud) { return method_.run(cloud, values_, context_); };
    const auto skin = Skin::where_filled(cloud, method_, values_, unreported_);
    if (!skin) return run(cloud);
    Result result = run_on(*skin, cloud, method_.minimum_points, context_, run);
    if (result.score <= by_chance || result.score == 1 || cloud.points.size() > few) return result;
    Result of_all = method_.run(cloud, values_, unreported_);
    return of_all.score == 1 ? of_all : result;
  }

  std::uint64_t seed_;
  const Method& method_;
  const ParameterValues& values_;
  const Context& context_;
  const Context unreported_ = context_.stage(0, 0);
};

}  // namespace

Result run_alone(PointsView points, const Options& options, const Method& method,
                 const ParameterValues& values, const Context& context) {
  require_corners(options.faces, points.size());
  // The thesis's methods get the points as they are.
  const TrianglesView faces = method.sees_strays ? TrianglesView() : options.faces;
  const Index least = faces.empty() ? method.minimum_points : 1;
  const Pipeline pipeline(options.seed, method, values, context);
  std::optional<NonfiniteRemoval> nonfinite;
  if (!options.refuse_nonfinite)
    nonfinite = NonfiniteRemoval::where_any(points, least, context.stage(0, 0));
  if (!nonfinite) return pipeline.run(points, options.normals, faces);

  require_normals(points, options.normals);
  const Points finite = nonfinite->apply(points);
  const Points normals = options.normals.empty() ? Points(0, 3) : nonfinite->apply(options.normals);
  Result result = pipeline.run(finite, normals, nonfinite->apply(faces, points.size()));
  nonfinite->map_back(result);
  return result;
}

}  // namespace symsurf
