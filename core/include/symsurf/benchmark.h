#pragma once

#include <symsurf/mirror.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace symsurf {

/// One case of the benchmark of curved mirrors: a shape, how its mirror is bent, what is done to
/// it.
struct BenchmarkCase {
  std::string name;      ///< "creature-waved-noise-1"
  std::string shape;     ///< "creature", "head", "part", "mask", "sheets"
  std::string bend;      ///< "straight", "bent", "domed", "waved", "twisted"; "none": no mirror
  std::string damage;    ///< "exact", "clean", "noise-0.5", "noise-1", "noise-2", "hole", "half",
                         ///< "density"
  double asymmetry = 0;  ///< root mean square of a smooth displacement, over the diagonal
};

/// The points of a case with its truth.
struct BenchmarkSample {
  Points points;
  Points images;                ///< of the points over the true mirror; no rows without a mirror
  std::vector<Index> partners;  ///< the row that a point's image is; -1: none
  /// The diagonal of the box of as many points before damage: the unit of all errors.
  double diagonal = 0;
  /// "plane", "cylinder", "sphere", or "graph": z = f(x, y) in a frame of its own; "none".
  std::string kind;
  /// Of a plane, cylinder or sphere, those of Mirror::numbers. Of a graph "formula", "amplitude",
  /// "frequency", "phase" (turns) or "slope", and x -> scale * rotation * x + translation from its
  /// frame.
  Values mirror;
};

/// All cases: every shape bent in every way under every damage and with smooth asymmetry of 1 and
/// 3 %, and shapes without a mirror.
const std::vector<BenchmarkCase>& benchmark_cases();

/// The case of that name with so many points. Its shape, pose and scale follow from the seed alone,
/// whatever the count and the damage. The same bits from one build of the library; another compiler
/// may round a sum otherwise and then draw other points. Throws InvalidParameter for a name that
/// is no case or a count below 100.
BenchmarkSample benchmark_sample(std::string_view name, Index count, std::uint64_t seed);

}  // namespace symsurf
