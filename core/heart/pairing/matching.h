#pragma once

#include <symsurf/context.h>
#include <symsurf/detect.h>
#include <symsurf/mirror.h>
#include <symsurf/parameter.h>

#include <cstdint>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/point_tree.h"

namespace symsurf {

/// Of each point the index of its partner, -1 none, and the squared distance of that from its
/// image.
struct Partners {
  std::vector<std::int32_t> index;
  Eigen::VectorXd squared;
};

/// For each point the nearest of the tree's points (the same cloud) to its image, where that is no
/// farther than `limit` (input units); of equally near ones that with the lowest index.
Partners find_partners(PointsView points, const PointTree& tree, const Mirror& mirror, double limit,
                       const Context& context);

/// Fills the result's pairs, residuals and surface points with what find_partners() finds, in the
/// order of the points. Releases the tree as soon as partners are known: it and the pairs never
/// need memory together.
void add_pairs(Result& result, const Cloud& cloud, const Mirror& mirror, double limit,
               const Context& context);

/// The same over the result's mirror, to the values' "pair_distance"; nothing where these want no
/// "pairs".
void add_pairs(Result& result, const Cloud& cloud, const ParameterValues& values,
               const Context& context);

/// The same over the mirror that was found of other points: of some of these, or of more on the
/// same surface. Surface points of mirrors of any shape are projected onto them, as their methods
/// do.
void pair_anew(Result& result, const Cloud& cloud, double limit, const Context& context);

/// Keeps these rows of the result's pairs, residuals and surface points.
void keep_pairs(Result& result, const std::vector<Index>& rows);

}  // namespace symsurf
