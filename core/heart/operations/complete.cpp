#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "base/disjoint_sets.h"
#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "cloud/point_tree.h"
#include "operations/counterparts.h"
#include "operations/meshes.h"
#include "operations/operation.h"

namespace symsurf {

namespace {

constexpr Index shift_neighbours = 16;  // that the shift of a point is the mean of
constexpr double touching = 4;          // spacings: less than two rows of faces of each rim

constexpr double usual_gaps = 4;    // medians: of a normal distribution one in 150 is more
constexpr double widths = 2;        // spacings
constexpr double cloud_gap = 3;     // spacings: gaps of random samples are narrower
constexpr double cloud_reach = 2;   // spacings between neighbours
constexpr Index within_reach = 16;  // points: about thirteen are

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
  if (c.face < 0) return false;
  if (c.past_rim) return true;
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

// The images of what is missing, their points behind those of the input.
class Completion {
 public:
  // `turned`: whether the images of faces are wound the other way.
  Completion(const OperationInput& input, const Counterparts& counterparts,
             const std::vector<bool>& missing, bool turned)
      : input_(input), counterparts_(counterparts), missing_(missing), turned_(turned) {
    if (input.faces.empty()) {
      for (Index i = 0; i < input.points.size(); ++i)
        if (missing[i]) sources_.push_back(i);
      return;
    }
    added_.meets_mesh.assign(input.points.size(), false);
    for (Index f = 0; f < input.faces.size(); ++f) {
      const Index* corner = input.faces[f];
      const int lost = missing[corner[0]] + missing[corner[1]] + missing[corner[2]];
      if (lost == 3) faces_.push_back(f);
      if (lost == 1 || lost == 2)
        for (int c = 0; c < 3; ++c) added_.meets_mesh[corner[c]] = true;
    }
  }

  // Leaves out the parts whose rim the shape does not surround.
  void keep_holes() {
    DisjointSets parts(input_.points.size());
    Triangles kept(static_cast<Index>(faces_.size()), 3);
    for (Index k = 0; k < kept.rows(); ++k) {
      const Index* corner = input_.faces[faces_[k]];
      kept.row(k) << corner[0], corner[1], corner[2];
      for (int c = 0; c < 2; ++c) parts.join(corner[c + 1], corner[c]);
    }
    std::vector<bool> is_open(input_.points.size(), false);
    const std::vector<bool> is_rim = TriangleMesh(input_.points, kept).is_boundary();
    for (const Index f : faces_)
      for (int c = 0; c < 3; ++c) {
        const Index i = input_.faces[f][c];
        if (is_rim[i] && !added_.meets_mesh[i]) is_open[parts.root(i)] = true;
      }
    std::erase_if(faces_, [&](Index f) { return is_open[parts.root(input_.faces[f][0])]; });
  }

  // Appends the points, bent to meet the shape over `reach`, and the faces.
  void append_to(OperationResult& result, double reach, const Context& context) {
    const Index first = input_.points.size();
    if (!faces_.empty()) {
      std::vector<Index> number(first, -1);
      for (const Index f : faces_)
        for (int c = 0; c < 3; ++c) number[input_.faces[f][c]] = 0;
      for (Index i = 0; i < first; ++i)
        if (number[i] == 0) {
          number[i] = first + static_cast<Index>(sources_.size());
          sources_.push_back(i);
        }
      added_.faces.resize(static_cast<Index>(faces_.size()), 3);
      for (Index k = 0; k < added_.faces.rows(); ++k) {
        const Index* corner = input_.faces[faces_[k]];
        added_.faces.row(k) << number[corner[0]], number[corner[1]], number[corner[2]];
        if (turned_) std::swap(added_.faces(k, 0), added_.faces(k, 2));
      }
    }
    added_.first = first;
    result.points.conservativeResize(first + static_cast<Index>(sources_.size()), 3);
    for (std::size_t k = 0; k < sources_.size(); ++k)
      result.points.row(first + static_cast<Index>(k)) =
          counterparts_.preimage(sources_[k]).transpose();
    if (reach > 0 && !sources_.empty()) bend(result.points, reach, context);
    append_faces(result, added_.faces, faces_);
  }

  // Joins the added faces to the rims of the shape; the corners there.
  std::vector<bool> close_seam(OperationResult& result, const Context& context) {
    std::vector<bool> joined(result.points.rows(), false);
    std::vector<bool> meets(sources_.size());
    for (std::size_t k = 0; k < sources_.size(); ++k) meets[k] = added_.meets_mesh[sources_[k]];
    added_.meets_mesh = meets;
    std::vector<bool> fillable(input_.points.size());
    for (std::size_t i = 0; i < fillable.size(); ++i) {
      const Counterpart& c = counterparts_[static_cast<Index>(i)];
      fillable[i] = c.matched && !c.on_rim;
    }
    const Triangles seam = seam_between(result.points, counterparts_.mesh(), added_, fillable,
                                        touching * counterparts_.spacing(), context);
    std::vector<Index> face_at(input_.points.size(), 0);
    for (Index f = 0; f < input_.faces.size(); ++f)
      for (int c = 0; c < 3; ++c) face_at[input_.faces[f][c]] = f;
    std::vector<Index> sources;
    for (const auto& corner : seam.rowwise()) {
      const Index i = corner[0];
      sources.push_back(face_at[i < added_.first ? i : sources_[i - added_.first]]);
      for (const Index j : corner) joined[j] = true;
    }
    append_faces(result, seam, sources);
    return joined;
  }

  const std::vector<Index>& sources() const { return sources_; }

 private:
  static constexpr Index grain = 512;  // points; some ten microseconds each

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
        auto x = points.row(added_.first + k);
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
  std::vector<Index> faces_;    // of the input, whose images are added
  std::vector<Index> sources_;  // of the added points
  AddedPart added_;
};

}  // namespace

void complete_by(const SymmetryMap& map, const ParameterValues& values, const Context& context,
                 OperationResult& result) {
  const Points given = result.points;
  const Triangles given_faces = result.faces;
  const std::vector<Index> point_sources = result.point_sources, face_sources = result.face_sources;
  const OperationInput input{given, given_faces};
  const Counterparts counterparts(input, map, limits_of(values, input.points),
                                  context.stage(0, 0.6));
  const std::vector<bool> missing = missing_points(
      input, counterparts, limits_of(values, input.points).distance, context.stage(0.6, 0.7));
  const Index points = given.rows(), faces = given_faces.rows();

  Completion completion(input, counterparts, missing, map.is_reflection());
  if (values.choice("fill") == "holes") completion.keep_holes();
  // What is nearest to a turned point of a cloud may be the other side of a wall; sides that differ
  // as those of a mirror do there are none.
  const bool is_bent = map.is_reflection() || !input.faces.empty();
  completion.append_to(result, is_bent ? values.real("blend") * diagonal_of(input.points) : 0,
                       context.stage(0.7, 0.9));
  const Index patch = result.faces.rows() - faces;
  Eigen::MatrixXd& origin = result.arrays["origin"];
  origin.conservativeResize(result.points.rows(), 1);
  origin.bottomRows(result.points.rows() - points).setConstant(mirrored);
  if (values.boolean("close_seam") && faces > 0) {
    const std::vector<bool> joined = completion.close_seam(result, context.stage(0.9, 1));
    for (Index i = points; i < result.points.rows(); ++i)
      if (joined[i]) origin(i, 0) = at_seam;
  }
  for (const Index i : completion.sources()) result.point_sources.push_back(point_sources[i]);
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

void run_complete(const OperationInput& input, const Mirror& mirror, const ParameterValues& values,
                  const Context& context, OperationResult& result) {
  start_completion(input, result);
  complete_by(mirror, values, context, result);
}

}  // namespace

OperationImplementation complete_operation() {
  OperationImplementation operation;
  operation.name = "complete";
  operation.title = "Mirror completion";
  operation.summary =
      "Adds what is missing: the images, over a mirror or turned about an axis, of the points and "
      "faces that are there.";
  operation.parameters = {
      Parameter::choice("fill", "all", {"all", "holes"},
                        "What to add: all that is missing, or of a mesh only what the shape "
                        "surrounds."),
      Parameter::boolean("close_seam", true,
                         "Join the added faces to the rims of the shape by more faces."),
      Parameter::real("blend", 0.05, 0, 1, "diagonal",
                      "From the rim as far as this, what is added is bent to meet the shape; 0: it "
                      "is the exact image."),
      max_distance(), max_angle()};
  operation.arrays = {{"origin", ParameterType::Integer, 1,
                       "0: a point of the input; 1: an image; 2: an image at the seam."}};
  operation.shown = "origin";
  operation.adds_points = true;
  operation.run = run_complete;
  return operation;
}

}  // namespace symsurf
