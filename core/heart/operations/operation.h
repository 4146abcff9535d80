#pragma once

#include <symsurf/operations.h>

#include <functional>
#include <vector>

#include "operations/counterparts.h"

namespace symsurf {

/// An operation and how it runs.
struct OperationImplementation : Operation {
  /// Fills in points, arrays and statistics; the points are there already, as they were given.
  std::function<void(const OperationInput& input, const Mirror& mirror,
                     const ParameterValues& values, const Context& context,
                     OperationResult& result)>
      run;
  /// The same about an axis, where the parameter "symmetry" says so: no mirror is needed then.
  void (*run_about_axis)(const OperationInput& input, const ParameterValues& values,
                         const Context& context, OperationResult& result) = nullptr;
};

/// Pairings that a satellite provides are passed in.
OperationImplementation asymmetry_operation(const Matchers& matchers);
OperationImplementation correspondences_operation(const Matchers& matchers);
OperationImplementation align_operation();
OperationImplementation complete_operation();
OperationImplementation symmetrize_operation(const Matchers& matchers);
OperationImplementation straighten_operation();
OperationImplementation transfer_operation(const Matchers& matchers);

/// Makes the result the shape itself, the source of each point and face its own.
void start_completion(const OperationInput& input, OperationResult& result);

/// Adds to the shape in `result` the preimages under a map of what they are missing from.
/// `own_points`: as OperationInput has it; only these are completed.
void complete_by(const SymmetryMap& map, const ParameterValues& values, const Context& context,
                 OperationResult& result, Index own_points = 0);

/// Whether an operation with these values is done over a mirror, not about an axis.
bool is_over_mirror(const OperationImplementation& operation, const ParameterValues& values);

/// Checks the input, runs the operation on its finite points and maps the result back. `mirror` may
/// be null where none is needed. Throws what operate() does.
OperationResult run_operation(const OperationImplementation& operation, const OperationInput& given,
                              const Mirror* mirror, const Values& parameters,
                              const Context& context);

/// Runs an operation on the first of two shapes. A rigid motion lays the second where a plane
/// beside the first mirrors it onto the first, by `map`, which takes the first onto the second:
/// both together are one shape with that mirror. Throws what operate() does.
OperationResult run_on_pair(const OperationImplementation& operation, const OperationInput& given,
                            const Matrix4& map, const Values& parameters, const Context& context);

/// What an operation works on where some points are not finite, as in clouds of depth cameras: the
/// others and the faces between them. The points left out keep their places in the result, without
/// values.
class FinitePart {
 public:
  /// Throws InvalidInput where no point is finite. Both must outlive it.
  FinitePart(const OperationInput& whole, const Operation& operation);
  FinitePart(const FinitePart&) = delete;
  FinitePart& operator=(const FinitePart&) = delete;

  const OperationInput& input() const { return part_; }

  /// Makes the result for the part that for the whole, and counts the points left out.
  void map_back(OperationResult& result) const;

 private:
  // Of one of the part, or added behind it, its number among the whole and what is added.
  Index whole_point(Index i) const;
  Index whole_face(Index f) const;
  void map_sources(OperationResult& result) const;
  void map_rows(OperationResult& result) const;
  void map_arrays(OperationResult& result) const;

  const OperationInput& whole_;
  const Operation& operation_;
  OperationInput part_;
  std::vector<Index> kept_points_, kept_faces_;  // where some are left out
  Points points_;
  Triangles faces_;
};

}  // namespace symsurf
