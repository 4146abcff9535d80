#pragma once

#include <symsurf/context.h>

#include "preprocess/preprocessing.h"
#include "preprocess/surface_samples.h"

namespace symsurf {

/// A shape as a sample of its surface without outliers.
struct SampledShape {
  SampledShape(const Cloud& shape, const Context& context)
      : outliers(minimum_points), cloud(shape) {
    const auto apply = [&](Stage& stage) {
      if (stage.apply(cloud, context))
        validate(cloud, needed_points(cloud, minimum_points), context);
    };
    apply(outliers);
    if (!cloud.faces.empty()) apply(samples);
  }

  static constexpr Index minimum_points = 10;
  OutlierRemoval outliers;
  SurfaceSamples samples;
  Cloud cloud;
};

}  // namespace symsurf
