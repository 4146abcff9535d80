#pragma once

#include <symsurf/detect.h>
#include <symsurf/parameter.h>

#include <cstdint>
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

/// A stage that keeps some of the points, in any order. Each point gets the partner of the one that
/// it is kept as.
class RowStage : public Stage {
 public:
  void map_back(Result& result, PairDistance pair_distance, const Context& context) const override;

 protected:
  DistinctPoints rows_;  ///< number -1: not kept
};

/// A stage that removes points: they have no partners, and `statistic` counts them.
class RowRemoval : public RowStage {
 public:
  void map_back(Result& result, PairDistance pair_distance, const Context& context) const override;

 protected:
  explicit RowRemoval(const char* statistic) : statistic_(statistic) {}

  /// `own`: the points of this process to remove. False: there are none in any process.
  bool remove(Cloud& cloud, const std::vector<Index>& own);

  static DistinctPoints without(Index points, const std::vector<Index>& removed);
  /// The faces between points that are kept, by their new indices.
  static Triangles renumbered(TrianglesView faces, const DistinctPoints& kept);

 private:
  const char* statistic_;
  Triangles faces_;
};

/// Removal of points with a NaN or infinite coordinate.
class NonfiniteRemoval : public RowRemoval {
 public:
  /// With `refuse` it changes nothing, and validation throws.
  NonfiniteRemoval(Index minimum_points, bool refuse)
      : RowRemoval("nonfinite_points"), minimum_points_(minimum_points), refuse_(refuse) {}

  /// Throws InvalidInput where some points are not finite and too few are. More points than a
  /// process can number are left to validation.
  bool apply(Cloud& cloud, const Context& context) override;

 private:
  Index minimum_points_;
  bool refuse_;
};

/// Merging of equal points: corners of triangles that nobody merged, a scan appended to itself.
/// Only where there are many; fewer than minimum_points distinct ones are InvalidInput. Each point
/// gets the partner of the one that it was merged with.
class DuplicateMerge : public RowStage {
 public:
  explicit DuplicateMerge(Index minimum_points) : minimum_points_(minimum_points) {}

  bool apply(Cloud& cloud, const Context& context) override;

 private:
  Index minimum_points_;
};

/// Sorting of the points by x, then y, then z: for methods that take the first of equals, which so
/// is the same one in whatever order the points were given. Copies keep their order.
class PositionOrder : public RowStage {
 public:
  bool apply(Cloud& cloud, const Context& context) override;
};

/// Removal of the few points far off the rest, which would set the scale of everything else.
/// What a scanner saw in the air, or pixels without depth that were written as the origin. At least
/// minimum_points stay. Where there are many copies of points, each counts once.
class OutlierRemoval : public RowRemoval {
 public:
  explicit OutlierRemoval(Index minimum_points)
      : RowRemoval("outliers"), minimum_points_(minimum_points) {}

  bool apply(Cloud& cloud, const Context& context) override;

 private:
  std::vector<Index> outliers_of(PointsView points, const Cloud& cloud,
                                 const Context& context) const;

  /// Whether faces between these points are a notable part of the surface: they are no outliers
  /// then.
  static bool hold_surface(const std::vector<Index>& own, const Cloud& cloud);

  Index minimum_points_;
};

}  // namespace symsurf
