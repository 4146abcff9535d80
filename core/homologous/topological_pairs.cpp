#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/disjoint_sets.h"
#include "base/linear_algebra.h"
#include "base/random.h"
#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "homologous_points.h"
#include "surface_graph.h"

namespace symsurf {

namespace {

constexpr int colour_rounds = 16;  // rings of faces around a vertex that tell it from others
constexpr Index most_walks = 64;   // over a part: a regular lattice has maps without end
constexpr Index compared_seeds = 64;
constexpr Index beside_parts = 16;                      // of many alike that are compared
constexpr Index frame_places = 16, frame_vertices = 4;  // of a part, and of the largest near each
constexpr double sound_near = 0.5;  // share of vertices: with a third of a body bent 0.6
constexpr double least_near = 0.3;  // share of vertices: with all limbs bent by 120 degrees 0.54
constexpr double alike = 0.95;      // share of the best map's worth: of a body others reach 0.5

// A number for each vertex, the same where the triangles around are alike, in either winding:
// colour refinement (Weisfeiler and Leman 1968).
// Vertices from `given` on are of another kind.
std::vector<std::uint64_t> colours_of(const SurfaceGraph& graph, Index given) {
  std::vector<std::uint64_t> colours(graph.vertices(), 0), next = colours;
  std::fill(colours.begin() + given, colours.end(), 1);
  for (int round = 0; round < colour_rounds; ++round) {
    for (Index i = 0; i < graph.vertices(); ++i) {
      next[i] = 3 * colours[i];
      for (const Index j : graph.neighbours(i)) next[i] += Random(colours[j]).bits();
      next[i] = Random(next[i]).bits();
    }
    colours.swap(next);
  }
  return colours;
}

struct ImagedMesh {
  Points points, images;  // over the mirror
  Triangles faces;
  Index given;  // vertices: others, behind them, divide polygons
};

// Without faces that name a vertex twice or have the corners of another.
Triangles proper_faces(const Triangles& faces) {
  std::vector<std::pair<std::array<Index, 3>, Index>> corners;
  for (Index f = 0; f < faces.rows(); ++f) {
    std::array own{faces(f, 0), faces(f, 1), faces(f, 2)};
    std::sort(own.begin(), own.end());
    if (own[0] != own[1] && own[1] != own[2]) corners.emplace_back(own, f);
  }
  std::sort(corners.begin(), corners.end());
  const auto end = std::unique(corners.begin(), corners.end(),
                               [](const auto& a, const auto& b) { return a.first == b.first; });
  Triangles proper(end - corners.begin(), 3);
  for (Index f = 0; f < proper.rows(); ++f) proper.row(f) = faces.row(corners[f].second);
  return proper;
}

// Triangles that follow each other may divide a polygon, and not alike on both sides: each about a
// vertex in its middle. Polygons are fans about their first corner, or quadrangles of two triangles
// with an edge. None: there are no polygons.
std::optional<ImagedMesh> divided_about_middles(const ImagedMesh& mesh, bool are_fans) {
  const Triangles& given = mesh.faces;
  std::vector<std::array<Index, 3>> faces;
  std::vector<Vector3> points, images;
  for (Index f = 0, next = 0; f < given.rows(); f = next) {
    std::vector<Index> corners{given(f, 0), given(f, 1), given(f, 2)};
    // Whether the next triangle has an edge, and with it another corner.
    const auto takes = [&](std::size_t at, int way) {
      const Index third = given(next, (way + 2) % 3);
      if (given(next, way) != corners[(at + 1) % corners.size()] ||
          given(next, (way + 1) % 3) != corners[at] || std::ranges::count(corners, third) > 0)
        return false;
      corners.insert(corners.begin() + static_cast<Index>(at) + 1, third);
      return true;
    };
    next = f + 1;
    if (are_fans)
      while (next < given.rows() && takes(corners.size() - 1, 0)) ++next;
    for (int k = 0; !are_fans && next == f + 1 && next < given.rows() && k < 9; ++k)
      if (takes(k / 3, k % 3)) ++next;
    if (next == f + 1) {
      faces.push_back({corners[0], corners[1], corners[2]});
      continue;
    }
    const Index middle = mesh.given + static_cast<Index>(points.size());
    points.push_back(mesh.points(corners, Eigen::indexing::all).colwise().mean().transpose());
    images.push_back(mesh.images(corners, Eigen::indexing::all).colwise().mean().transpose());
    for (std::size_t k = 0; k < corners.size(); ++k)
      faces.push_back({corners[k], corners[(k + 1) % corners.size()], middle});
  }
  if (points.empty()) return {};
  const Index all = mesh.given + static_cast<Index>(points.size());
  ImagedMesh divided{Points(all, 3), Points(all, 3), rows_of(faces), mesh.given};
  divided.points << mesh.points, rows_of(points);
  divided.images << mesh.images, rows_of(images);
  return divided;
}

class TopologicalPairs {
 public:
  TopologicalPairs(ImagedMesh mesh, const Context& context)
      : mesh_(std::move(mesh)),
        graph_(points_.rows(), mesh_.faces = proper_faces(mesh_.faces)),
        colours_(colours_of(graph_, mesh_.given)),
        table_(graph_),
        scale_(usual_slide * diagonal_of(points_)) {
    find_parts();
    std::vector<Vector3> middles;
    for (const Part& part : parts_) middles.push_back(part.middle);
    if (middles.empty()) return;
    const PointTree tree(rows_of(middles), context);
    std::optional<PointTree> frame;  // the vertices of the largest part
    for (Index k = 0; k < static_cast<Index>(parts_.size()); ++k) {
      context.check();
      if (parts_[k].is_done) continue;
      const bool found = pair(k, tree, frame, context);
      if (k == 0 && found) frame.emplace(of(points_, parts_[0]), context);
    }
  }

  Index operator[](Index i) const { return table_[i]; }

  const ImagedMesh& mesh() const { return mesh_; }

  Index vertices() const { return vertices_; }    ///< given ones of faces
  Index paired() const { return paired_; }        ///< of these
  Index ambiguous() const { return ambiguous_; }  ///< which another map pairs about as well
  Index parts() const { return static_cast<Index>(parts_.size()); }
  /// Sum over these: 1 where the partner is the image, 0 far from it.
  double nearness() const { return near_; }
  double near() const { return near_ / static_cast<double>(paired_); }  ///< share of paired()
  Index maps() const { return maps_; }  ///< of the largest part; of a lattice some of them

 private:
  struct Part {
    std::vector<std::int32_t> vertices;  // by colour
    Vector3 middle;
    Index given;                // vertices
    std::uint64_t colours = 0;  // the sum
    bool is_done = false;
  };

  // The rows of a part's vertices.
  static Points of(const Points& rows, const Part& part) {
    return rows(part.vertices, Eigen::indexing::all);
  }

  std::int32_t left_neighbour(Index i) const {
    for (const std::int32_t j : graph_.neighbours(i))
      if (graph_.thirds(i, j)[0] >= 0) return j;
    return -1;
  }

  void find_parts() {
    PartnerTable same(graph_);
    for (std::int32_t i = 0; i < graph_.vertices(); ++i) {
      const std::int32_t j = left_neighbour(i);
      if (same[i] >= 0 || j < 0) continue;
      const Corner corner{i, j, graph_.thirds(i, j)[0]};
      same.grow(corner, corner);
      Part part;
      for (std::size_t k = 0; k < same.joined().size(); k += 2) {
        part.vertices.push_back(static_cast<std::int32_t>(same.joined()[k]));
        part.colours += colours_[part.vertices.back()];
      }
      same.keep();
      std::sort(part.vertices.begin(), part.vertices.end(), [&](Index a, Index b) {
        return std::pair(colours_[a], a) < std::pair(colours_[b], b);
      });
      part.middle = of(points_, part).colwise().mean().transpose();
      part.given = std::ranges::count_if(part.vertices, [&](Index k) { return k < mesh_.given; });
      vertices_ += part.given;
      parts_.push_back(std::move(part));
    }
    std::stable_sort(parts_.begin(), parts_.end(), [](const Part& a, const Part& b) {
      return a.vertices.size() > b.vertices.size();
    });
    for (Index k = 0; k < parts(); ++k) alike_[parts_[k].colours].push_back(k);
  }

  auto of_colour(const Part& part, std::uint64_t colour) const {
    return std::ranges::equal_range(part.vertices, colour, {},
                                    [&](Index i) { return colours_[i]; });
  }

  // The images of a part's vertices: over the mirror, or, of a part beside the largest one, by the
  // motion of that part, which a pose may have moved.
  Points targets_of(const Part& part, const std::optional<PointTree>& frame) const {
    if (!frame) return of(images_, part);
    std::vector<Neighbour> near;
    std::vector<std::pair<Vector3, Vector3>> pairs;
    const auto count = static_cast<Index>(part.vertices.size());
    const Index places = std::min(count, frame_places);
    for (Index k = 0; k < places; ++k) {
      frame->nearest(points_.row(part.vertices[k * count / places]).transpose(),
                     std::min(frame_vertices, frame->size()), near);
      for (const Neighbour& n : near) {
        const Index i = parts_[0].vertices[n.index];
        pairs.emplace_back(points_.row(i), points_.row(table_[i]));
      }
    }
    const Eigen::Isometry3d moved = nearest_isometry(pairs, -1);
    return (of(points_, part) * moved.linear().transpose()).rowwise() +
           moved.translation().transpose();
  }

  // The part itself and others that look like it.
  std::vector<Index> images_of(Index own, const Points& targets, const PointTree& middles) const {
    const std::vector<Index>& all = alike_.at(parts_[own].colours);
    std::vector<Index> found{own};
    const auto add = [&](Index k) {
      if (k > own && !parts_[k].is_done && parts_[k].colours == parts_[own].colours &&
          parts_[k].vertices.size() == parts_[own].vertices.size())
        found.push_back(k);
    };
    if (static_cast<Index>(all.size()) <= beside_parts) {
      for (const Index k : all) add(k);
      return found;
    }
    const Vector3 middle = targets.colwise().mean().transpose();
    std::vector<Neighbour> near;
    if (middle.allFinite()) middles.nearest(middle, std::min(beside_parts, middles.size()), near);
    for (const Neighbour& n : near) add(n.index);
    return found;
  }

  // Infinite without an image.
  double squared_gap(const Points& targets, Index row, Index image) const {
    const double squared = (targets.row(row) - points_.row(image)).squaredNorm();
    return squared >= 0 ? squared : std::numeric_limits<double>::infinity();
  }

  // The row of the vertex nearest to an image, among those of the part's least common colour.
  Index seed_of(const Part& part, const Points& targets, const std::vector<Index>& images) const {
    auto rarest = of_colour(part, colours_[part.vertices.front()]);
    for (auto at = rarest.end(); at != part.vertices.end();) {
      const auto same = of_colour(part, colours_[*at]);
      if (same.size() < rarest.size()) rarest = same;
      at = same.end();
    }
    const auto first = static_cast<Index>(rarest.begin() - part.vertices.begin());
    const auto count = static_cast<Index>(rarest.size());
    Index seed = first;
    double least = std::numeric_limits<double>::infinity();
    for (Index k = 0; k < std::min(count, compared_seeds); ++k) {
      const Index row = first + k * count / std::min(count, compared_seeds);
      for (const Index other : images)
        for (const Index image : of_colour(parts_[other], colours_[*rarest.begin()]))
          if (const double squared = squared_gap(targets, row, image); squared < least) {
            least = squared;
            seed = row;
          }
    }
    return seed;
  }

  // The share of a part's vertices that come near to their images.
  double worth_of(const Part& part, const Points& targets) const {
    double sum = 0;
    for (Index row = 0; row < targets.rows(); ++row) {
      const double squared = squared_gap(targets, row, table_[part.vertices[row]]);
      sum += 1 / (1 + squared / (scale_ * scale_));
    }
    return sum / static_cast<double>(targets.rows());
  }

  // Whether a part has a map.
  bool pair(Index own, const PointTree& middles, const std::optional<PointTree>& frame,
            const Context& context) {
    Part& part = parts_[own];
    part.is_done = true;
    const Points targets = targets_of(part, frame);
    const std::vector<Index> images = images_of(own, targets, middles);
    const Index row = seed_of(part, targets, images);
    const std::int32_t a = part.vertices[row];
    // Parts that meet in a vertex have it once.
    const auto row_of = [&](Index i) {
      return std::ranges::find(part.vertices, i) - part.vertices.begin();
    };
    const auto around = graph_.neighbours(a);
    const auto beside = std::ranges::find_if(
        around, [&](Index j) { return graph_.thirds(a, j)[0] >= 0 && row_of(j) < targets.rows(); });
    if (beside == around.end()) return false;
    const std::int32_t b = *beside;
    const Corner seed{a, b, graph_.thirds(a, b)[0]};
    const Index row_of_b = row_of(b);
    std::vector<std::tuple<double, Index, Corner>> starts;
    for (const Index other : images)
      for (const std::int32_t i : of_colour(parts_[other], colours_[a]))
        for (const std::int32_t j : graph_.neighbours(i))
          for (const int wound : {1, 0}) {  // onto itself against its winding alone
            const std::int32_t third = graph_.thirds(i, j)[wound];
            if ((wound == 0 && other == own) || third < 0 || colours_[j] != colours_[b] ||
                colours_[third] != colours_[seed[2]])
              continue;
            starts.emplace_back(squared_gap(targets, row, i) + squared_gap(targets, row_of_b, j),
                                other, Corner{i, j, third});
          }
    std::sort(starts.begin(), starts.end());
    const auto count = static_cast<Index>(part.vertices.size());
    double best = 0, second = 0;
    Index walked = 0, maps = 0, image = own;
    std::vector<Index> partners;
    for (const auto& [gap, other, to] : starts) {
      if (walked > most_walks * count) break;
      context.check();
      const bool is_map = table_.grow(seed, to) && std::ranges::all_of(part.vertices, [&](Index i) {
                            return table_[i] >= 0;
                          });
      walked += static_cast<Index>(table_.joined().size());
      if (is_map) {
        ++maps;
        const double worth = worth_of(part, targets);
        second = std::max(second, std::min(worth, best));
        if (worth > best || partners.empty()) {
          best = worth;
          image = other;
          partners.clear();
          for (const std::int32_t i : part.vertices) partners.push_back(table_[i]);
        }
      }
      table_.undo();
    }
    if (own == 0) maps_ = maps;
    if (partners.empty()) return false;
    for (Index k = 0; k < count; ++k) table_.join(part.vertices[k], partners[k]);
    table_.keep();
    parts_[image].is_done = true;
    const Index both = image == own ? part.given : 2 * part.given;
    paired_ += both;
    near_ += best * static_cast<double>(both);
    if (second >= alike * best) ambiguous_ += both;
    return true;
  }

  ImagedMesh mesh_;
  const Points &points_ = mesh_.points, &images_ = mesh_.images;
  const SurfaceGraph graph_;
  const std::vector<std::uint64_t> colours_;
  PartnerTable table_;
  const double scale_;  // of distances that matter, input units
  std::vector<Part> parts_;
  std::map<std::uint64_t, std::vector<Index>> alike_;  // parts of the same colours
  Index vertices_ = 0, paired_ = 0, ambiguous_ = 0, maps_ = 0;
  double near_ = 0;
};

// Of each vertex the sign of the half of its surface: that of the sum of the distances from the
// mirror; 0 of one that is its own partner, NaN without one.
Eigen::VectorXd sides_of(const TopologicalPairs& partner, const Eigen::VectorXd& distances) {
  const Index count = distances.size();
  DisjointSets halves(count);
  for (const auto& face : partner.mesh().faces.rowwise())
    for (int c = 0; c < 3; ++c)
      if (const Index a = face[c], b = face[(c + 1) % 3];
          partner[a] != a && partner[b] != b && partner[a] != b)
        halves.join(a, b);
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(count), sides(count);
  for (Index i = 0; i < count; ++i)
    if (std::isfinite(distances[i])) sums[halves.root(i)] += distances[i];
  for (Index i = 0; i < count; ++i) {
    const Index j = partner[i];
    const double excess = j < 0    ? std::numeric_limits<double>::quiet_NaN()
                          : j == i ? 0
                                   : sums[halves.root(i)] - sums[halves.root(j)];
    sides[i] = excess > 0 ? 1 : excess < 0 ? -1 : excess;
  }
  return sides;
}

std::string count_of(Index some, Index all) {
  return std::to_string(some) + " of " + std::to_string(all) + " vertices";
}

}  // namespace

HomologousPoints topological_pairs(const OperationInput& input, const SymmetryMap& map,
                                   PointsView images, const Context& context) {
  const PointsView given = input.points;
  const TrianglesView given_faces = input.faces;
  if (given_faces.empty())
    throw InvalidInput("the pairing topology needs faces; none given for " +
                       std::to_string(given.size()) + " points");
  const DistinctPoints distinct = distinct_points(given, context.stage(0, 0.1));
  ImagedMesh mesh{given.matrix()(distinct.first, Eigen::indexing::all),
                  images.matrix()(distinct.first, Eigen::indexing::all),
                  Triangles(given_faces.size(), 3), static_cast<Index>(distinct.first.size())};
  for (Index f = 0; f < given_faces.size(); ++f)
    for (int c = 0; c < 3; ++c) mesh.faces(f, c) = distinct.number[given_faces[f][c]];
  auto pairing = std::make_unique<TopologicalPairs>(mesh, context.stage(0.1, 0.5));
  for (const bool are_fans : {true, false}) {
    if (pairing->paired() == pairing->vertices() && pairing->near() > sound_near) break;
    const std::optional<ImagedMesh> divided = divided_about_middles(mesh, are_fans);
    if (!divided) continue;
    auto other = std::make_unique<TopologicalPairs>(*divided, context.stage(0.5, 0.9));
    if (other->nearness() > pairing->nearness()) pairing = std::move(other);
  }
  const TopologicalPairs& partner = *pairing;
  if (2 * partner.paired() < partner.vertices() || partner.paired() == 0)
    throw InvalidInput(
        "the triangulation is not symmetric: " + count_of(partner.paired(), partner.vertices()) +
        " lie in connected parts (" + std::to_string(partner.parts()) +
        " in all) that a mirrored map takes onto themselves or onto another; the "
        "pairing topology needs at least half of them; closest and homologous need none");
  HomologousPoints found{Points::Zero(given.size(), 3),       std::vector<Index>(given.size(), -1),
                         Eigen::VectorXd::Zero(given.size()), Eigen::VectorXd::Zero(given.size()),
                         Eigen::VectorXd(given.size()),       {}};
  // Of copies one that faces use.
  std::vector<Index> first(distinct.first.begin(), distinct.first.end());
  for (Index f = given_faces.size() - 1; f >= 0; --f)
    for (int c = 0; c < 3; ++c) first[distinct.number[given_faces[f][c]]] = given_faces[f][c];
  const Eigen::VectorXd sides =
      sides_of(partner, map.signed_distance(partner.mesh().points, context.stage(0.9, 1)));
  for (Index i = 0; i < given.size(); ++i) {
    const Index own = distinct.number[i], other = partner[own];
    found.sides[i] = sides[own];
    if (other < 0 || other >= mesh.given) continue;
    found.partners[i] = first[other];
    found.known[i] = 1;
  }
  found.statistics["mirror_maps"] = partner.maps();
  found.statistics["near_share"] = partner.near();
  std::string& warning =
      std::get<std::string>(found.statistics.try_emplace("warning", std::string()).first->second);
  if (const Index none = partner.vertices() - partner.paired(); none > 0)
    warning =
        count_of(none, partner.vertices()) +
        " lie in connected parts whose triangulation is not symmetric, and have no counterparts";
  else if (partner.ambiguous() > 0)
    warning = "another map of the triangulation pairs " +
              count_of(partner.ambiguous(), partner.vertices()) +
              " about as well as the one that was taken";
  else if (partner.near() < least_near)
    warning = "few vertices come near to the images of their partners (near_share " +
              to_string(Value(partner.near())) +
              "): the map of the triangulation may be another symmetry than that of the mirror";
  if (warning.empty()) found.statistics.erase("warning");
  return found;
}

}  // namespace symsurf
