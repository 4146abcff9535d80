#pragma once

#include "search/methods.h"

namespace symsurf {

/// The way of a cloud through a method: validation, pre-processing, the method, mapping back.
/// `cloud`: what the caller gave, with its seed.
Result run_pipeline(const MethodImplementation& method, const ParameterValues& values, Cloud cloud,
                    bool refuse_nonfinite, const Context& context);

/// detect() of points that are all in this process, by a method.
Result detect_in_one(PointsView points, const Options& options, const MethodImplementation& method,
                     const ParameterValues& values, const Context& context);

/// The diagonal that a method's lengths are fractions of, outliers removed as it does.
double diagonal_of(PointsView points, const Options& options, const MethodImplementation& method,
                   const Context& context);

/// The method that found a result, which "auto" leaves to others, and how far it lets a partner be,
/// in diagonals: none where it looks for no pairs.
struct Finder {
  const MethodImplementation& method;
  PairDistance pair_distance;
};
Finder finder_of(const Result& result, const MethodImplementation& method,
                 const ParameterValues& values);

/// Sets the statistics that depend on the pairs of the input's points: `paired` of `total`, whose
/// residuals have that sum.
void report_pairs(Result& result, const MethodImplementation& finder, Index paired, Index total,
                  double residuals);

}  // namespace symsurf
