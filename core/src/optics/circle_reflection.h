#pragma once

#include <Eigen/Core>
#include <vector>

namespace symsurf {

/// The points of the unit circle, as unit vectors, at which light is reflected from a source to an
/// eye in its plane (Alhazen's problem): at most four.
///
/// With complex numbers s, e and z on the circle, s / z - 1 and e / z - 1 are where they are seen
/// from z along the normal. Light is reflected where these have opposite angles, so that their
/// product is real and positive: Im(s e / z^2 - (s + e) / z) = 0.
std::vector<Eigen::Vector2d> circle_reflection(const Eigen::Vector2d& source,
                                               const Eigen::Vector2d& eye);

}  // namespace symsurf
