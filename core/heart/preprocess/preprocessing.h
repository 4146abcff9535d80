#pragma once

#include <symsurf/detect.h>
#include <symsurf/parameter.h>

#include <memory>
#include <optional>
#include <vector>

#include "cloud/cloud.h"

namespace symsurf {

/// The pre-processing that a method asks for.
struct Preprocessing {
  bool remove_outliers = true, sample_faces = true, merge_duplicates = true,
       extract_boundary = true;
  bool order_points = false;  ///< by position: where the method takes the first of equals
  /// Whether the boundary of this volumetric cloud is not extracted after all. Null: never.
  bool (*keep_interior)(const Cloud&, const ParameterValues&, const Context&) = nullptr;

  static Preprocessing none() { return {false, false, false, false}; }
  static Preprocessing order_only() { return {false, false, false, false, true}; }
};

/// How far a partner may be, in diagonals; none: no pairs are wanted.
using PairDistance = std::optional<double>;

/// A pre-processing stage: changes the cloud, and maps the result of the changed cloud back.
class Stage {
 public:
  virtual ~Stage() = default;

  /// Makes the cloud what the next stage gets, to be validated anew; false: nothing to change. The
  /// cloud's new rows live as long as the stage.
  virtual bool apply(Cloud& cloud, const Context& context) = 0;

  /// Makes the result of the changed cloud that of the cloud given.
  virtual void map_back(Result& result, PairDistance pair_distance,
                        const Context& context) const = 0;

 protected:
  void replace(Cloud& cloud, Points points, Points normals);

  /// Keeps these rows. A mirror is still drawn over all.
  template <typename Integer>
  void keep(Cloud& cloud, const std::vector<Integer>& rows) {
    if (cloud.footprint.empty()) cloud.footprint = cloud.points;
    replace(cloud, chosen_rows(cloud.points, rows), chosen_rows(cloud.normals, rows));
  }

 private:
  Points points_, normals_ = Points(0, 3);
};

/// How many points a cloud needs for a method: any number where samples of its faces will follow.
inline Index needed_points(const Cloud& cloud, Index minimum_points) {
  return cloud.faces.empty() ? minimum_points : 1;
}

/// All stages, in their order. The first precedes validation.
std::vector<std::unique_ptr<Stage>> make_stages(const Preprocessing& policy, Index minimum_points,
                                                const ParameterValues& values,
                                                bool refuse_nonfinite);

}  // namespace symsurf
