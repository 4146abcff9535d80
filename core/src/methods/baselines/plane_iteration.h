#pragma once

#include <symsurf/detect.h>
#include <symsurf/parameter.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/unit_plane.h"
#include "spatial/point_tree.h"

namespace symsurf {

/// Points in the principal frame and, of each, the one nearest to its image over a plane.
struct Correspondences {
  const Points& points;
  const std::vector<Neighbour>& partner;
};

/// The next plane, from the correspondences over this one.
using PlaneUpdate = std::function<UnitPlane(const Correspondences&, const UnitPlane&)>;

/// The thinned cloud that starts are tried on: positions of about 500 surfels, in the
/// principal frame.
Points thinned_points(const Cloud& cloud, const Context& context);

/// Iterative closest points under a reflection (Besl and McKay 1992), coarse to fine: nearest
/// points, then the update, until the plane rests. From every start on the thinned cloud; the best
/// few planes go on on all points, and the score ranks them.
Result iterated_planes(const std::string& method, const Cloud& cloud, const Points& thinned,
                       const std::vector<UnitPlane>& starts, const PlaneUpdate& update,
                       const ParameterValues& values, const Context& context);

/// The best of the planes by the score, with its pairs; the others are its candidates.
Result ranked_planes(const std::string& method, const Cloud& cloud,
                     const std::vector<std::shared_ptr<Mirror>>& planes,
                     const ParameterValues& values, const Context& context);

/// The parameter "normal" of a start, and the start that it asks for; none where it is zero.
Parameter start_normal(std::string doc);
std::vector<UnitPlane> given_start(const Cloud& cloud, const ParameterValues& values);

}  // namespace symsurf
