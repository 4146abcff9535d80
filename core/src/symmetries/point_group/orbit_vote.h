#pragma once

#include <vector>

#include "score/mirror_score.h"
#include "symmetries/point_group/symmetry_fit.h"

namespace symsurf {

/// What the orbits of a cloud's points say of a group: of the images of a point under all elements,
/// how many lie on the cloud.
struct OrbitVote {
  double support = 0;   ///< share of the images on the surface, of those where the cloud has points
  double fit = 0;       ///< the mean of their supports, a measure of how close they come
  double missing = 0;   ///< share of the images that do
  double outliers = 0;  ///< share of the points that too few of their images confirm
  double share() const { return support * (1 - missing); }
};

/// With part of a shape missing, most images of a point that is no part's alone still lie on the
/// cloud; those of a feature that spoils the symmetry, such as a handle, do not. No single element
/// distinguishes the two, as either has an image where the cloud has nothing.
/// Looks at about so many images; a few hundred points at most are asked for theirs.
OrbitVote orbit_vote(const MirrorScore& score, const GroupPose& pose,
                     const std::vector<Matrix3>& elements, std::size_t most_images);

}  // namespace symsurf
