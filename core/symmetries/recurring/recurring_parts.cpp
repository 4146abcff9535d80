#include "recurring/recurring_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "analysis.h"
#include "base/math.h"
#include "cloud/closest_point_on_mesh.h"
#include "preprocess/boundary.h"

namespace symsurf {

namespace {

// Of the maps to instances, that a line needs an image by.
double share_with_image(const ConnectedLines& around) {
  return around.graph().noise > 0 ? least_share : 1;
}

// Of how far a turn takes the seed: by how much a match may miss a power of it.
constexpr double same_place = 0.1;

// The powers of a turn of that order: matches of the seed, or where noise has left none, what is
// taken on by the turn. None where too few are there or the last does not lead back.
std::vector<LocalMatch> powers_of(const LocalMatch& turn, Index order, const ConnectedLines& around,
                                  const std::vector<LocalMatch>& matches) {
  const Vector3 seed = around.middle(0);
  const double near = same_place * (turn.map * seed - seed).norm();
  std::vector<LocalMatch> powers{matches.front()};
  Index having = 1;
  while (static_cast<Index>(powers.size()) < order) {
    LocalMatch power = around.after(turn, powers.back());
    for (const LocalMatch& match : matches)
      if ((match.map * seed - power.map * seed).norm() < near &&
          Eigen::AngleAxisd(match.map.linear().transpose() * power.map.linear()).angle() <
              same_turn) {
        power = match;
        break;
      }
    having += power.images[0] >= 0 ? 1 : 0;
    powers.push_back(std::move(power));
  }
  const bool closes = (turn.map * powers.back().map * seed - seed).norm() < near;
  if (!closes ||
      static_cast<double>(having) < share_with_image(around) * static_cast<double>(order))
    powers.clear();
  return powers;
}

// The powers of the least turn of finite order.
std::vector<LocalMatch> least_turn(const ConnectedLines& around,
                                   const std::vector<LocalMatch>& matches) {
  std::vector<LocalMatch> ring;
  for (const LocalMatch& turn : matches) {
    if (turn.map.linear().determinant() < 0) continue;
    const double angle = Eigen::AngleAxisd(turn.map.linear()).angle();
    if (angle < same_turn) continue;
    const auto order = static_cast<Index>(std::round(2 * std::numbers::pi / angle));
    const double whole = static_cast<double>(order) * angle - 2 * std::numbers::pi;
    const Index most = std::max<Index>(2, static_cast<Index>(ring.size()));
    if (order <= most || std::abs(whole) > same_turn) continue;
    std::vector<LocalMatch> powers = powers_of(turn, order, around, matches);
    if (!powers.empty()) ring = std::move(powers);
  }
  return ring;
}

// The mean squared distance of lines from their centre.
double spread_of(const LocalLines& part, const ConnectedLines& around) {
  Vector3 centre = Vector3::Zero();
  for (const std::int32_t line : part) centre += around.middle(line);
  centre /= static_cast<double>(part.size());
  double sum = 0;
  for (const std::int32_t line : part) sum += (around.middle(line) - centre).squaredNorm();
  return sum / static_cast<double>(part.size());
}

}  // namespace

RingSector ring_sector(const ConnectedLines& around, const std::vector<LocalMatch>& matches) {
  RingSector found{{}, least_turn(around, matches)};
  if (found.turns.empty()) return found;
  std::vector<const LocalMatch*> turns;
  for (const LocalMatch& turn : found.turns) turns.push_back(&turn);
  // Of the sectors that begin with a line each, the most compact one.
  constexpr double less = 1 - 1e-6;
  std::vector<char> seen(around.graph().lines.size(), 0);
  double narrowest = infinity;
  for (std::size_t line = 0; line < around.size(); ++line) {
    if (seen[around.number(line)]) continue;
    for (const LocalMatch& turn : found.turns)
      if (turn.images[line] >= 0) seen[turn.images[line]] = 1;
    LocalLines own = around.disjoint(turns, static_cast<std::int32_t>(line), around.middle(line),
                                     share_with_image(around));
    if (own.empty()) continue;
    const double spread = spread_of(own, around);
    if (own.size() < found.lines.size() ||
        (own.size() == found.lines.size() && spread >= less * narrowest))
      continue;
    narrowest = spread;
    found.lines = std::move(own);
  }
  return found;
}

namespace {

// Lines that make up a part; where other lines go on from it more: the sides of a prism or cube are
// none.
constexpr std::size_t least_lines = 3, least_lines_of_piece = 5;

// Of what the best candidate saves: another that saves as much, and is a whole or has more
// instances, comes before it.
constexpr double nearly_best = 0.75;

// Matches by how many of the lines around the seed they hold; each level is tried.
constexpr std::size_t most_levels = 40;

// Of the table of images: so many entries are 64 MB.
constexpr std::size_t most_entries = std::size_t{1} << 24;

// Matches of a seed with lines that are alike, the identity first, then those that turn less.
std::vector<LocalMatch> matches_of(Index seed, const std::vector<Index>& alike,
                                   const ConnectedLines& around, const LineMatch& own,
                                   LineMatching& matching, const Context& context) {
  struct Found {
    LocalMatch match;
    double plainness;
  };
  std::vector<Found> found{{around.local(own), 0}};
  for (const Index other : alike)
    for (const LineMatching::Pose pose : LineMatching::poses) {
      context.check();
      if (other == seed && !pose.reversed && !pose.reflected) continue;
      if (found.size() * around.size() > most_entries) break;
      const auto match = matching.grown(seed, other, pose);
      if (match && match->lines.size() >= least_lines)
        found.push_back({around.local(*match), match->plainness()});
    }
  constexpr double rounding = 1e-6;
  std::stable_sort(found.begin() + 1, found.end(), [&](const Found& a, const Found& b) {
    return std::round(a.plainness / rounding) > std::round(b.plainness / rounding);
  });
  std::vector<LocalMatch> matches;
  for (Found& each : found) matches.push_back(std::move(each.match));
  return matches;
}

// Considers parts around a seed.
class PartOfSeed {
 public:
  PartOfSeed(const ConnectedLines& around, const std::vector<LocalMatch>& matches)
      : around_(around), matches_(matches) {}

  RecurringPart run() {
    consider_levels();
    // A whole that recurs is a part, and no ring of its sectors.
    if (std::none_of(candidates_.begin(), candidates_.end(),
                     [](const RecurringPart& part) { return part.is_whole; })) {
      const RingSector ring = ring_sector(around_, matches_);
      consider(ring.lines, ring.turns);
    }
    const auto best = best_part(candidates_);
    return best == candidates_.end() ? RecurringPart() : std::move(*best);
  }

 private:
  // What all of the matches that hold at least so much have in common, level by level.
  void consider_levels() {
    std::vector<double> levels;
    for (const LocalMatch& match : matches_) levels.push_back(match.length);
    std::sort(levels.rbegin(), levels.rend());
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    const std::size_t stride = levels.size() / most_levels + 1;
    for (std::size_t k = 0; k < levels.size(); k += stride) {
      std::vector<const LocalMatch*> level;
      for (const LocalMatch& match : matches_)
        if (match.length >= levels[k]) level.push_back(&match);
      consider(around_.common(level, share_with_image(around_)), matches_);
    }
  }

  // A part of these lines: as many instances as do not share a line, of maps in their order.
  void consider(const LocalLines& part, const std::vector<LocalMatch>& maps) {
    const bool is_whole = part.size() == around_.size();
    if (part.size() < (is_whole ? least_lines : least_lines_of_piece)) return;
    RecurringPart found;
    found.is_whole = is_whole;
    std::vector<char> claimed(around_.graph().lines.size(), 0);
    for (const std::int32_t line : part) {
      found.lines.push_back(around_.number(line));
      found.length += around_.line(line).length;
    }
    // Those that have all lines first: noise may take lines from others.
    for (const LocalMatch& match : maps) add_instance(match, part, found.length, claimed, found);
    if (around_.graph().noise > 0)
      for (const LocalMatch& match : maps)
        add_instance(match, part, least_share * found.length, claimed, found);
    // A pair is one only as a whole: of two halves of a body all lines go on to the other.
    const std::size_t least = is_whole ? 2 : 3;
    if (found.instances.size() >= least) candidates_.push_back(std::move(found));
  }

  // Where images of at least that length are there, and none is claimed.
  void add_instance(const LocalMatch& match, const LocalLines& part, double least,
                    std::vector<char>& claimed, RecurringPart& found) const {
    RecurringPart::Instance instance{match.map, {}};
    double length = 0;
    for (const std::int32_t line : part) {
      const std::int32_t image = match.images[line];
      if (image < 0) continue;
      if (claimed[image]) return;
      instance.lines.push_back(image);
      length += around_.line(line).length;
    }
    constexpr double rounding = 1e-9;
    if (length < (1 - rounding) * least) return;
    for (const Index image : instance.lines) claimed[image] = 1;
    found.instances.push_back(std::move(instance));
  }

  const ConnectedLines& around_;
  const std::vector<LocalMatch>& matches_;  // the identity first
  std::vector<RecurringPart> candidates_;
};

}  // namespace

std::size_t RecurringPart::complete_instances() const {
  return std::count_if(instances.begin(), instances.end(), [&](const Instance& instance) {
    return instance.lines.size() == lines.size();
  });
}

std::vector<RecurringPart>::iterator best_part(std::vector<RecurringPart>& parts) {
  double most = 0;
  for (const RecurringPart& part : parts) most = std::max(most, part.saved());
  const auto comes_before = [](const RecurringPart& a, const RecurringPart& b) {
    constexpr double more = 1 + 1e-9;
    if (a.is_whole != b.is_whole) return a.is_whole;
    if (a.complete_instances() != b.complete_instances())
      return a.complete_instances() > b.complete_instances();
    return a.saved() > more * b.saved();
  };
  auto best = parts.end();
  for (auto part = parts.begin(); part != parts.end(); ++part)
    if (part->saved() >= nearly_best * most && (best == parts.end() || comes_before(*part, *best)))
      best = part;
  return best;
}

RecurringPart seed_part(Index seed, const std::vector<Index>& alike, const FeatureLines& graph,
                        LineMatching& matching, const Context& context) {
  const auto own = matching.grown(seed, seed, {false, false});
  if (!own || own->lines.size() < least_lines) return {};
  const ConnectedLines around(graph, *own);
  const std::vector<LocalMatch> matches = matches_of(seed, alike, around, *own, matching, context);
  return matches.size() > 1 ? PartOfSeed(around, matches).run() : RecurringPart();
}

namespace {

// Standard deviations of the noise: what the ends of two lines may be apart for it.
constexpr double beyond_noise = 4;

// Of that: the mean length of a part's lines. Shorter ones, as of skulls, agree by chance.
constexpr double longer_than_noise = 5;

// Radians, and of how far it moves a part: what a map may miss the symmetry by that it is named
// after.
constexpr double named_angle = 0.02, named_share = 0.1;

void run_recurring_parts(const ColouredCloud& cloud, const ParameterValues& values,
                         const Context& context, AnalysisResult& result) {
  // In diagonals, from the centroid.
  Points scaled = cloud.points.matrix();
  scaled.rowwise() -= cloud.frame.centroid.transpose();
  scaled /= cloud.diagonal;
  const double angle = values.real("feature_angle") * std::numbers::pi / 180;
  std::optional<CloudFacets> facets;
  FeatureLines graph;
  if (!cloud.faces.empty()) {
    graph = feature_lines(scaled, cloud.faces, angle, context.stage(0, 0.2));
  } else if (!is_volumetric(cloud, context.stage(0, 0.02))) {  // within a body facets are chance
    facets.emplace(scaled, context.stage(0.02, 0.1));
    graph = feature_lines(*facets, angle, context.stage(0.1, 0.2));
  }
  const double tolerance = std::max(values.real("tolerance"), beyond_noise * graph.noise);
  std::vector<RecurringPart> parts =
      part_search(graph, tolerance, values.integer("count"), context.stage(0.2, 0.8));
  std::erase_if(parts, [&](const RecurringPart& part) {
    return static_cast<Index>(part.instances.size()) < values.integer("minimum_instances") ||
           part.length < longer_than_noise * beyond_noise * graph.noise *
                             static_cast<double>(part.lines.size());
  });
  std::optional<ClosestPointOnMesh> closest;
  if (!cloud.faces.empty()) closest.emplace(scaled, cloud.faces, context.stage(0.8, 0.9));
  const auto to_surface = [&](const Vector3& x) {
    if (facets) return facets->squared_distance(x);
    const ClosestPoint nearest = (*closest)(x, 4 * tolerance * tolerance);
    return nearest.face < 0 ? infinity : nearest.squared_distance;
  };
  const PartPoints points =
      part_points(scaled, graph, parts, tolerance, to_surface, context.stage(0.9, 1));

  const Index count = cloud.points.size();
  Eigen::VectorXd part(count), instance(count);
  for (Index i = 0; i < count; ++i) {
    part[i] = static_cast<double>(points.part[i]);
    instance[i] = static_cast<double>(points.instance[i]);
  }
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Vector3 middle =
        cloud.points.matrix()(points.members[p][0], Eigen::indexing::all).colwise().mean();
    for (std::size_t k = 0; k < parts[p].instances.size(); ++k) {
      Transformation transformation;
      Eigen::Isometry3d map = parts[p].instances[k].map;
      map.translation() *= cloud.diagonal;
      const Eigen::Translation3d from_centroid(cloud.frame.centroid);
      transformation.matrix = (from_centroid * map * from_centroid.inverse()).matrix();
      const Vector3 moved = (transformation.matrix * middle.homogeneous()).head<3>() - middle;
      // But the first none is the identity, however little it moves.
      transformation.kind =
          k == 0 ? "identity"
                 : kind_of(transformation.matrix, middle, named_angle,
                           std::min(tolerance * cloud.diagonal, named_share * moved.norm()));
      transformation.score = points.scores[p][k];
      transformation.from = points.members[p][0];
      transformation.onto = points.members[p][k];
      result.transformations.push_back(std::move(transformation));
    }
  }
  result.arrays = {{"part", part}, {"instance", instance}};
  result.statistics["parts"] = static_cast<Index>(parts.size());
  result.statistics["instances"] = static_cast<Index>(result.transformations.size());
  result.statistics["noise"] = graph.noise * cloud.diagonal;
  result.statistics["feature_lines"] = static_cast<Index>(graph.lines.size());
}

}  // namespace

AnalysisImplementation recurring_parts_analysis() {
  AnalysisImplementation analysis;
  analysis.name = "recurring_parts";
  analysis.title = "Recurring parts";
  analysis.summary =
      "Finds the parts of a mesh or cloud that recur, such as windows or teeth, by its feature "
      "lines (Bokeloh et al. 2009).";
  analysis.parameters = {
      Parameter::real("feature_angle", 30, 1, 179, "degrees",
                      "Facets that meet at more than this angle have a feature line between them."),
      Parameter::real(
          "tolerance", 0.002, 1e-6, 0.1, "diagonal",
          "Maximum distance between two instances of a part when they are superimposed."),
      Parameter::integer("minimum_instances", 2, 2, 1000000, "",
                         "Minimum number of instances of a part."),
      Parameter::integer("count", 20, 1, 1000, "", "Maximum number of parts to find."),
  };
  analysis.arrays = {
      {"part", ParameterType::Integer, 1,
       "Index of the part to which the point belongs, -1: none."},
      {"instance", ParameterType::Integer, 1, "Index of the instance of that part, -1: none."},
  };
  analysis.shown = "instance";
  analysis.finds_transforms = true;
  analysis.run = run_recurring_parts;
  return analysis;
}

}  // namespace symsurf
