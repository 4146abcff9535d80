#include "operations/missing_points.h"

#include <algorithm>

#include "base/math.h"
#include "spatial/point_tree.h"

namespace symsurf {

namespace {

constexpr double usual_gaps = 4;    // medians: of a normal distribution one in 150 is more
constexpr double widths = 2;        // spacings
constexpr double cloud_gap = 3;     // spacings: gaps of random samples are narrower
constexpr double cloud_reach = 2;   // spacings between neighbours
constexpr Index within_reach = 16;  // points: about thirteen are

// Adds what for_each_neighbour(i, visit) visits to the points that are missing already.
template <typename ForEachNeighbour>
void spread(std::vector<bool>& missing, const Context& context,
            const ForEachNeighbour& for_each_neighbour) {
  std::vector<Index> front;
  for (Index i = 0; i < static_cast<Index>(missing.size()); ++i)
    if (missing[i]) front.push_back(i);
  for (std::size_t done = 0; done < front.size(); ++done) {
    if (done % 1024 == 0) context.check();
    for_each_neighbour(front[done], [&](Index j) {
      if (missing[j]) return;
      missing[j] = true;
      front.push_back(j);
    });
  }
}

// The same over a mesh, to vertices that are doubtful; of doubtful ones as many at a place at the
// most as are missing for sure.
void spread_over_mesh(std::vector<bool>& missing, const TriangleMesh& mesh,
                      const std::vector<bool>& doubtful, const Context& context) {
  std::vector<bool> done(missing.size(), false);
  for (Index start = 0; start < static_cast<Index>(missing.size()); ++start) {
    if (!missing[start] || done[start]) continue;
    std::vector<Index> part{start};
    done[start] = true;
    Index sure = 0;
    for (std::size_t k = 0; k < part.size(); ++k) {
      if (k % 1024 == 0) context.check();
      sure += missing[part[k]];
      for (const Index j : mesh.neighbours(part[k]))
        if (!done[j] && (missing[j] || doubtful[j])) {
          done[j] = true;
          part.push_back(j);
        }
    }
    if (2 * sure >= static_cast<Index>(part.size()))
      for (const Index i : part) missing[i] = true;
  }
}

bool is_beyond(const OperationInput& input, const Counterparts& counterparts, Index i,
               double max_distance) {
  const Counterpart& c = counterparts[i];
  if (c.face < 0) return false;
  if (c.past_rim) return true;
  if (c.gap <= max_distance) return false;
  if (!counterparts.is_watertight()) return true;
  // Within a closed surface nothing is missing: there lies the image of where it was broken.
  const Vector3 normal = counterparts.normals().row(input.faces[c.face][0]).transpose();
  return (counterparts.image(i) - c.on_surface).dot(normal) > 0;
}

// How far images lie off the surface that they are images of, input units: not much farther than
// most do, nor than faces are wide.
double farthest_above(const Counterparts& counterparts, Index count) {
  std::vector<double> gaps;
  for (Index i = 0; i < count; ++i)
    if (counterparts[i].matched) gaps.push_back(counterparts[i].gap);
  const double usual = gaps.empty() ? 0 : median(std::move(gaps));
  return std::max(usual_gaps * usual, widths * counterparts.spacing());
}

// Nothing can be added where the mirror has no image of the other side.
std::vector<bool> with_images(std::vector<bool> missing, const Counterparts& counterparts) {
  for (Index i = 0; i < static_cast<Index>(missing.size()); ++i)
    missing[i] = missing[i] && counterparts.image(i).allFinite();
  return missing;
}

}  // namespace

std::vector<bool> missing_points(const OperationInput& input, const Counterparts& counterparts,
                                 double max_distance, const Context& context) {
  const Index count = input.points.size();
  std::vector<bool> missing(count, false);
  if (!input.faces.empty()) {
    for (Index i = 0; i < count; ++i) missing[i] = is_beyond(input, counterparts, i, max_distance);
    // Beside what is missing an image that lies off the surface lies above another part of it.
    const double apart = farthest_above(counterparts, count);
    std::vector<bool> doubtful(count, false);
    for (Index i = 0; i < count; ++i) {
      const Counterpart& c = counterparts[i];
      doubtful[i] = c.face >= 0 && (!c.matched || c.gap > apart);
    }
    spread_over_mesh(missing, counterparts.mesh(), doubtful, context);
    return with_images(std::move(missing), counterparts);
  }
  const double gap = cloud_gap * counterparts.spacing();
  const double reach = cloud_reach * counterparts.spacing();
  for (Index i = 0; i < count; ++i) {
    const Counterpart& c = counterparts[i];
    if (c.nearest < 0) continue;
    const double distance = (counterparts.image(i) - input.points[c.nearest]).norm();
    missing[i] = c.past_rim ? distance > gap : c.gap > max_distance;
  }
  const PointTree tree(input.points, context);
  std::vector<Neighbour> near;
  spread(missing, context, [&](Index i, const auto& visit) {
    tree.nearest(input.points[i], within_reach, near);
    for (const Neighbour& n : near)
      if (n.squared_distance < reach * reach && counterparts[n.index].past_rim) visit(n.index);
  });
  return with_images(std::move(missing), counterparts);
}

}  // namespace symsurf
