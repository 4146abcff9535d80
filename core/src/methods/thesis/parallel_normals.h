#pragma once

#include <symsurf/context.h>
#include <symsurf/points_view.h>

#include <array>
#include <cstdint>
#include <vector>

#include "methods/thesis/separation.h"

namespace symsurf {

/// Finds, for points of X1, the point q of X2 whose normal makes the smallest angle with theirs
/// (equal angles: the lowest index). The few most parallel of the whole cloud are listed once; the
/// first of these that lies in X2 is q, and only where the list does not tell, the normals of X2
/// are searched. Positions are places along a curve through the normals, which keeps what is
/// parallel together.
class ParallelNormals {
 public:
  /// Unit normals, one a point; as_lines: their sign does not count.
  ParallelNormals(PointsView points, PointsView normals, bool as_lines, const Context& context);

  /// Mean squared distance of the partners b from q (3.5), input units squared.
  double projection_error(const Separation& separation) const;

 private:
  struct Listed {
    std::int32_t position = -1;  // -1: no more
    bool is_tied = false;        // the next may be as parallel
  };
  using List = std::array<Listed, 8>;
  using Partners = std::vector<std::int32_t>;  // by position; -1: lies in X2

  void list_most_parallel();
  // Where rounding may decide about all that are listed, by cosine and index themselves.
  void list_ties();
  // The position of q; -1 where the list does not tell.
  std::int32_t listed(Index position, const Partners& partners) const;
  // The sum of |b - q|^2 over positions whose q is not listed.
  double searched(const std::vector<std::int32_t>& positions, const Partners& partners) const;

  PointsView points_, normals_;
  const Context context_;
  bool as_lines_;
  std::vector<std::int32_t> order_, position_;  // indices by position, positions by index
  Points sorted_points_, sorted_normals_;       // by position
  std::vector<List> lists_;                     // by position
};

}  // namespace symsurf
