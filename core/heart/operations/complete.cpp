#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "cloud/point_tree.h"
#include "cloud/triangulation.h"
#include "operations/counterparts.h"
#include "operations/meshes.h"
#include "operations/operation.h"

namespace symsurf {

namespace {

constexpr Index shift_neighbours = 16;  // that the shift of a point is the mean of
constexpr double touching = 4;          // spacings: less than two rows of faces of each rim

constexpr double usual_gaps = 4;           // medians: of a normal distribution one in 150 is more
constexpr double widths = 2;               // spacings
constexpr double cloud_gap = 3;            // spacings: gaps of random samples are narrower
constexpr double cloud_reach = 2;          // spacings between neighbours
constexpr Index within_reach = 16;         // points: about thirteen are
constexpr std::size_t largest_hole = 512;  // edges: to fill one takes time by their cube

// Adds vertices that are doubtful beside those that are missing; of doubtful ones as many at a
// place at the most as are missing for sure.
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
  if (c.past_rim) return true;
  if (c.face < 0) return false;
  if (c.gap <= max_distance) return false;
  if (!counterparts.is_watertight()) return true;
  // Within a closed surface nothing is missing: there lies the image of where it was broken.
  const Vector3 normal = counterparts.normals().row(input.faces[c.face][0]).transpose();
  return (counterparts.preimage(i) - c.on_surface).dot(normal) > 0;
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

// Nothing can be added where a mirror has no image of the other side.
std::vector<bool> with_images(std::vector<bool> missing, const Counterparts& counterparts) {
  for (Index i = 0; i < static_cast<Index>(missing.size()); ++i)
    missing[i] = missing[i] && counterparts.preimage(i).allFinite();
  return missing;
}

// For each point whether its image is missing from the shape: the surface ends before it, or lies
// more than `max_distance` (input units) away.
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
    const double distance = (counterparts.preimage(i) - input.points[c.nearest]).norm();
    missing[i] = c.past_rim ? distance > gap : c.gap > max_distance;
  }
  const PointTree tree(input.points, context);
  std::vector<Neighbour> near;
  std::vector<Index> front;
  for (Index i = 0; i < count; ++i)
    if (missing[i]) front.push_back(i);
  for (std::size_t done = 0; done < front.size(); ++done) {
    if (done % 1024 == 0) context.check();
    tree.nearest(input.points[front[done]], within_reach, near);
    for (const Neighbour& n : near) {
      if (n.squared_distance >= reach * reach || !counterparts[n.index].past_rim) continue;
      if (!missing[n.index]) front.push_back(n.index);
      missing[n.index] = true;
    }
  }
  return with_images(std::move(missing), counterparts);
}

enum Origin { original, mirrored, at_seam };

// The images of what is missing, their points behind those of the input. They are welded to the
// shape where each point around them has an exact partner; elsewhere a seam is to join them.
class Completion {
 public:
  // `turned`: whether the images of faces are wound the other way.
  Completion(const OperationInput& input, const Counterparts& counterparts,
             const std::vector<bool>& missing, bool turned)
      : input_(input),
        counterparts_(counterparts),
        missing_(missing),
        turned_(turned),
        parts_(input.points.size()),
        islands_(input.points.size()),
        number_(input.points.size(), -1) {
    const Index count = input.points.size();
    if (input.faces.empty()) {
      for (Index i = 0; i < count; ++i)
        if (missing[i]) sources_.push_back(i);
      return;
    }
    const double exact = 2 * mirror_tolerance * diagonal_of(input.points);
    for (Index i = 0; i < count; ++i)
      if (const Index j = counterparts[i].nearest;
          j >= 0 && !missing[i] && (counterparts.preimage(i) - input.points[j]).norm() <= exact)
        number_[i] = j;
    meets_mesh_.assign(count, false);
    std::vector<Index> beside;  // of the parts that are beside something else, a point each
    std::set<std::pair<Index, Index>> rims;
    for (const std::vector<Index>& loop : counterparts.mesh().boundary_loops())
      for (std::size_t k = 0; k < loop.size(); ++k)
        rims.insert(std::minmax(loop[k], loop[(k + 1) % loop.size()]));
    const auto has_room = [&](Index a, Index b) {  // beside an edge of the shape, or for a new one
      if (counterparts.is_half() || a < 0 || b < 0 || rims.contains(std::minmax(a, b))) return true;
      const std::vector<Index> around = counterparts.mesh().neighbours(a);
      return !std::binary_search(around.begin(), around.end(), b);
    };
    for (Index f = 0; f < input.faces.size(); ++f) {
      const Index* corner = input.faces[f];
      const int lost = missing[corner[0]] + missing[corner[1]] + missing[corner[2]];
      if (lost == 0 || is_degenerate(corner)) continue;
      faces_.push_back(f);
      const Index part = missing_corner(f);
      for (int c = 0; c < 3; ++c) {
        const Index own = corner[c];
        if (missing[own])
          parts_.join(own, part);
        else if (number_[own] < 0 || !has_room(number_[own], number_[corner[(c + 1) % 3]]))
          beside.push_back(part);
        if (lost < 3) meets_mesh_[corner[c]] = true;
      }
    }
    is_beside_.assign(count, false);
    for (const Index i : beside) is_beside_[parts_.root(i)] = true;
    std::erase_if(faces_, [&](Index f) {
      const Index* corner = input.faces[f];
      return is_beside_[part_of(f)] &&
             !(missing[corner[0]] && missing[corner[1]] && missing[corner[2]]);
    });
    std::stable_partition(faces_.begin(), faces_.end(),
                          [&](Index f) { return !is_beside_[part_of(f)]; });
  }

  // Leaves out the parts whose rim the shape does not surround.
  void keep_holes() {
    Triangles kept(static_cast<Index>(faces_.size()), 3);
    for (Index k = 0; k < kept.rows(); ++k)
      kept.row(k) = Eigen::Map<const Triangles>(input_.faces[faces_[k]], 1, 3);
    std::vector<bool> is_open(input_.points.size(), false);
    const std::vector<bool> is_rim = TriangleMesh(input_.points, kept).is_boundary();
    for (Index i = 0; i < input_.points.size(); ++i)
      if (missing_[i] && is_rim[i] && !meets_mesh_[i]) is_open[parts_.root(i)] = true;
    std::erase_if(faces_, [&](Index f) { return is_open[part_of(f)]; });
  }

  // Appends the points, bent to meet the shape over `reach`, and the faces.
  void append_to(OperationResult& result, double reach, const Context& context) {
    const Index first = input_.points.size();
    const auto welded = std::partition_point(faces_.begin(), faces_.end(),
                                             [&](Index f) { return !is_beside_[part_of(f)]; });
    const auto number_points = [&](auto begin, auto end) {
      std::vector<bool> used(first, false);
      for (; begin != end; ++begin)
        for (int c = 0; c < 3; ++c) used[input_.faces[*begin][c]] = true;
      for (Index i = 0; i < first; ++i)
        if (used[i] && number_[i] < 0) {
          number_[i] = first + static_cast<Index>(sources_.size());
          sources_.push_back(i);
        }
    };
    number_points(faces_.begin(), welded);
    first_beside_ = first + static_cast<Index>(sources_.size());
    faces_beside_ = faces_.end() - welded;
    number_points(welded, faces_.end());
    Triangles faces(static_cast<Index>(faces_.size()), 3);
    for (Index k = 0; k < faces.rows(); ++k)
      for (int c = 0; c < 3; ++c)
        faces(k, turned_ ? 2 - c : c) = number_[input_.faces[faces_[k]][c]];
    result.points.conservativeResize(first + static_cast<Index>(sources_.size()), 3);
    for (std::size_t k = 0; k < sources_.size(); ++k)
      result.points.row(first + static_cast<Index>(k)) =
          counterparts_.preimage(sources_[k]).transpose();
    if (reach > 0 && !sources_.empty()) bend(result.points, reach, context);
    append_faces(result, faces, faces_);
  }

  // Joins the added faces to the rims of the shape and fills the holes that are left; the corners
  // there.
  std::vector<bool> close_seam(OperationResult& result, const Context& context) {
    const Index count = input_.points.size();
    AddedPart added{first_beside_, result.faces.bottomRows(faces_beside_), {}};
    for (Index k = first_beside_ - count; k < static_cast<Index>(sources_.size()); ++k)
      added.meets_mesh.push_back(meets_mesh_[sources_[k]]);
    const TriangleMesh before(
        PointsView(result.points.data(), first_beside_),
        TrianglesView(result.faces.data(), result.faces.rows() - faces_beside_), context);
    std::vector<Index> face_at(count, 0);
    for (Index f = 0; f < input_.faces.size(); ++f)
      for (int c = 0; c < 3; ++c) face_at[input_.faces[f][c]] = f;
    std::vector<bool> joined(result.points.rows(), false);
    const auto append = [&](const Triangles& seam) {
      std::vector<Index> sources;
      for (const auto& corner : seam.rowwise()) {
        const Index i = corner[0];
        sources.push_back(face_at[i < count ? i : sources_[i - count]]);
        for (const Index j : corner) joined[j] = true;
      }
      append_faces(result, seam, sources);
    };
    append(seam_between(result.points, before, added, touching * counterparts_.spacing(), context));
    const TriangleMesh whole(result.points, result.faces, context);
    std::vector<bool> is_boundary = whole.is_boundary();
    const auto goes_on = [&](Index i) {  // the surface, beyond the rim
      const bool is_other = i >= input_.own().size() && i < count;
      if (!is_boundary[i] || is_other) return false;
      if (i >= count) return bool(meets_mesh_[sources_[i - count]]);
      const Counterpart& c = counterparts_[i];
      return c.face >= 0 && !c.past_rim && (!c.on_rim || c.nearest == i);
    };
    for (const Index f : faces_)
      for (int c = 0; c < 2; ++c) islands_.join(input_.faces[f][c], input_.faces[f][c + 1]);
    std::vector<Index> alone;  // of each loop of what was added that nothing is joined to
    for (const std::vector<Index>& loop : whole.boundary_loops()) {
      if (loop.size() > largest_hole || !std::all_of(loop.begin(), loop.end(), goes_on)) continue;
      context.check();
      if (std::all_of(loop.begin(), loop.end(), [&](Index i) { return i >= count; })) {
        alone.push_back(loop[0]);
        continue;
      }
      append(loop_triangulation(result.points, loop));
      for (const Index i : loop) is_boundary[i] = false;
    }
    const std::vector<bool> was_boundary = counterparts_.mesh().is_boundary();
    for (const Index k : alone) {
      Index rim = -1;
      for (Index i = 0; i < count; ++i)
        if (was_boundary[i] &&
            (rim < 0 || (result.points.row(i) - result.points.row(k)).norm() <
                            (result.points.row(rim) - result.points.row(k)).norm()))
          rim = i;
      if (rim >= 0 && !is_boundary[rim]) apart_.push_back(islands_.root(sources_[k - count]));
    }
    return joined;
  }

  // No longer counts as missing what lies in a hole that was filled without it; false: nothing
  // does.
  bool drop_what_lies_apart(std::vector<bool>& missing) {
    for (Index i = 0; i < input_.points.size(); ++i)
      if (std::find(apart_.begin(), apart_.end(), islands_.root(i)) != apart_.end())
        missing[i] = false;
    return !apart_.empty();
  }

  const std::vector<Index>& sources() const { return sources_; }

 private:
  static constexpr Index grain = 512;  // points; some ten microseconds each

  Index missing_corner(Index f) const {
    const Index* corner = input_.faces[f];
    return *std::find_if(corner, corner + 2, [&](Index i) { return missing_[i]; });
  }
  Index part_of(Index f) { return parts_.root(missing_corner(f)); }

  static void append_faces(OperationResult& result, const Triangles& faces,
                           const std::vector<Index>& sources) {
    const Index before = result.faces.rows();
    result.faces.conservativeResize(before + faces.rows(), 3);
    result.faces.bottomRows(faces.rows()) = faces;
    result.face_sources.insert(result.face_sources.end(), sources.begin(), sources.end());
  }

  // Where the sides differ the images end beside the shape. They are shifted as the images next to
  // them lie off it: modified Shepard weights (Franke and Nielson, 1980), fading to 0 over `reach`.
  void bend(Points& points, double reach, const Context& context) const {
    std::vector<Vector3> images, shifts;
    for (Index i = 0; i < input_.points.size(); ++i) {
      const Counterpart& c = counterparts_[i];
      if (!c.matched || missing_[i] || !counterparts_.preimage(i).allFinite()) continue;
      images.push_back(counterparts_.preimage(i));
      shifts.push_back(c.on_surface - images.back());
    }
    if (images.empty()) return;
    const Points known = rows_of(images);
    const PointTree tree(known, context);
    parallel_for(context, static_cast<Index>(sources_.size()), grain, [&](Index begin, Index end) {
      std::vector<Neighbour> near;
      for (Index k = begin; k < end; ++k) {
        auto x = points.row(input_.points.size() + k);
        tree.nearest(x.transpose(), shift_neighbours, near);
        const double distance = std::sqrt(near.front().squared_distance);
        const double fade = biweight(distance / reach);
        if (fade == 0) continue;
        const double radius = std::sqrt(near.back().squared_distance);
        Vector3 sum = Vector3::Zero();
        double weights = 0;
        for (const Neighbour& n : near) {
          const double d = std::max(std::sqrt(n.squared_distance), 1e-9 * radius);
          const double root = (radius - d) / (radius * d);
          sum += root * root * shifts[n.index];
          weights += root * root;
        }
        if (weights > 0) x += (fade / weights * sum).transpose();
      }
    });
  }

  const OperationInput& input_;
  const Counterparts& counterparts_;
  const std::vector<bool>& missing_;
  bool turned_;
  DisjointSets parts_;            // of missing points
  DisjointSets islands_;          // of the points of added faces
  std::vector<bool> is_beside_;   // of the root of each part: whether a seam is to join it
  std::vector<Index> number_;     // in the result, of the image of each point; -1: none yet
  std::vector<Index> faces_;      // of the input, whose images are added: those welded first
  std::vector<Index> sources_;    // of the added points
  std::vector<bool> meets_mesh_;  // one a point, missing or not: beside what is the other
  Index first_beside_ = 0, faces_beside_ = 0;  // behind what is welded
  std::vector<Index> apart_;  // roots of islands in holes that were closed without them
};

}  // namespace

void complete_by(const SymmetryMap& map, const ParameterValues& values, const Context& context,
                 OperationResult& result, Index own_points) {
  const Points given = result.points;
  const Triangles given_faces = result.faces;
  const std::vector<Index> point_sources = result.point_sources, face_sources = result.face_sources;
  OperationInput input{given, given_faces};
  input.own_points = own_points;
  const Counterparts::Limits limits = limits_of(values, input.own());
  const Counterparts counterparts(input, map, limits, context.stage(0, 0.6));
  std::vector<bool> missing =
      missing_points(input, counterparts, limits.distance, context.stage(0.6, 0.7));
  std::fill(missing.begin(), missing.begin() + own_points, false);
  const Index points = given.rows(), faces = given_faces.rows();

  // What is nearest to a turned point of a cloud may be the other side of a wall; sides that differ
  // as those of a mirror do there are none.
  const bool is_bent = map.is_reflection() || faces > 0;
  const double reach = is_bent ? values.real("blend") * diagonal_of(input.own()) : 0;
  std::optional<Completion> completion;
  std::vector<bool> joined;
  Index patch = 0;
  do {
    result.points = given;
    result.faces = given_faces;
    result.face_sources = face_sources;
    completion.emplace(input, counterparts, missing, map.is_reflection());
    if (values.choice("fill") == "holes") completion->keep_holes();
    completion->append_to(result, reach, context.stage(0.7, 0.9));
    patch = result.faces.rows() - faces;
    joined.assign(result.points.rows(), false);
    if (values.boolean("close_seam") && faces > 0)
      joined = completion->close_seam(result, context.stage(0.9, 1));
  } while (completion->drop_what_lies_apart(missing));
  Eigen::MatrixXd& origin = result.arrays["origin"];
  origin.conservativeResize(result.points.rows(), 1);
  for (Index i = points; i < result.points.rows(); ++i)
    origin(i, 0) = joined[i] ? at_seam : mirrored;
  for (const Index i : completion->sources()) result.point_sources.push_back(point_sources[i]);
  for (std::size_t f = face_sources.size(); f < result.face_sources.size(); ++f)
    result.face_sources[f] = face_sources[result.face_sources[f]];
  if (map.is_reflection()) counterparts.report(result.statistics);
  const auto count = [&](const char* name, Index more) {
    Value& sum = result.statistics.try_emplace(name, Index{0}).first->second;
    sum = std::get<Index>(sum) + more;
  };
  count("added_points", result.points.rows() - points);
  count("added_faces", patch);
  count("seam_faces", result.faces.rows() - faces - patch);
}

void start_completion(const OperationInput& input, OperationResult& result) {
  result.point_sources.resize(input.points.size());
  result.face_sources.resize(input.faces.size());
  std::iota(result.point_sources.begin(), result.point_sources.end(), 0);
  std::iota(result.face_sources.begin(), result.face_sources.end(), 0);
  result.arrays["origin"] = Eigen::MatrixXd::Constant(input.points.size(), 1, original);
}

namespace {

// Nothing is asked of the shape: half a model has no other side to compare with.
void add_image(const OperationInput& input, const Mirror& mirror, const Context& context,
               OperationResult& result) {
  const Index points = input.points.size(), faces = input.faces.size();
  const Eigen::VectorXd distances = mirror.signed_distance(input.points, context.stage(0, 0.5));
  const double near = mirror_tolerance * diagonal_of(input.points);
  Half half{result.points, result.faces, {}, {}, result.face_sources, std::vector<bool>(points)};
  for (Index i = 0; i < points; ++i) half.on_mirror[i] = std::abs(distances[i]) <= near;
  const MirroredHalf whole = with_image(std::move(half), mirror, context.stage(0.5, 1));
  result.points = whole.points;
  for (Index i = 0; i < points; ++i)
    if (whole.partners[i] != i) result.point_sources.push_back(i);
  // The image of a face within the mirror is the face.
  std::vector<Index> added;
  for (Index f = 0; f < faces; ++f)
    if (const Index* c = input.faces[f];
        std::any_of(c, c + 3, [&](Index i) { return !whole.on_mirror[i]; }))
      added.push_back(f);
  const auto more = static_cast<Index>(added.size());
  result.faces.conservativeResize(faces + more, 3);
  for (Index k = 0; k < more; ++k) result.faces.row(faces + k) = whole.faces.row(faces + added[k]);
  result.face_sources.insert(result.face_sources.end(), added.begin(), added.end());
  result.arrays["origin"].conservativeResize(result.points.rows(), 1);
  result.arrays["origin"].bottomRows(result.points.rows() - points).setConstant(mirrored);
  const Index other =
      std::min((distances.array() > near).count(), (distances.array() < -near).count());
  result.statistics = {{"added_points", result.points.rows() - points},
                       {"added_faces", more},
                       {"seam_faces", Index{0}},
                       {"points_on_mirror", 2 * points - result.points.rows()}};
  std::string warning;
  if (other > 0)
    warning = std::to_string(other) + " of " + std::to_string(points) +
              " points lie on the other side of the mirror, where the image overlaps the shape";
  else if (more < faces)
    warning = std::to_string(faces - more) + " of " + std::to_string(faces) +
              " faces lie within the mirror: they divide the inside of the result";
  if (!warning.empty())
    result.statistics["warning"] = warning + "; cut with capped=False leaves these out";
}

void run_complete(const OperationInput& input, const Mirror& mirror, const ParameterValues& values,
                  const Context& context, OperationResult& result) {
  start_completion(input, result);
  if (values.boolean("search"))
    complete_by(mirror, values, context, result, input.own_points);
  else if (input.own_points > 0)
    throw InvalidParameter("search is false beside a second shape; allowed is true");
  else
    add_image(input, mirror, context, result);
}

}  // namespace

OperationImplementation complete_operation() {
  OperationImplementation operation;
  operation.name = "complete";
  operation.title = "Mirror completion";
  operation.summary =
      "Adds missing parts: the images, over a mirror or about an axis, of the points and faces "
      "that exist.";
  operation.parameters = {
      Parameter::boolean("search", true,
                         "Search for what is missing; false: add the exact image of all points and "
                         "faces, welded at the mirror, as half a model needs it."),
      Parameter::choice(
          "fill", "all", {"all", "holes"},
          "What to add: all missing parts or, for a mesh, only those that the shape surrounds."),
      Parameter::boolean("close_seam", true,
                         "Join the added faces to the boundary of the shape by further faces."),
      Parameter::real("blend", 0.05, 0, 1, "diagonal",
                      "Width of the band along the boundary in which the added part is deformed to "
                      "meet the shape; 0: the exact image."),
      max_distance(),
      max_angle()};
  operation.arrays = {{"origin", ParameterType::Integer, 1,
                       "0: a point of the input; 1: an image; 2: an image at the seam."}};
  operation.shown = "origin";
  operation.adds_points = operation.takes_other = true;
  operation.run = run_complete;
  return operation;
}

}  // namespace symsurf
