#include "pairs/placement_search.h"

#include <algorithm>
#include <cmath>

#include "base/math.h"
#include "base/random.h"
#include "fit/candidate.h"

namespace symsurf {

namespace {

using Placement = Candidate<UnitPlacement>;

constexpr Index most_patches = 1000;

Index patches_of(const Cloud& cloud) { return std::min(most_patches, cloud.points.size() / 2); }

}  // namespace

PlacedShape::PlacedShape(const Cloud& cloud, const Context& context)
    : frame(cloud.frame),
      coarse(cloud.patches(patches_of(cloud), context.stage(0, 0.4))),
      map(coarse),
      points(cloud, context),
      refinement(cloud, points, coarse,
                 cloud.finer_patches(patches_of(cloud), context.stage(0.4, 0.7))),
      score(cloud, context.stage(0.7, 1)) {}

PlacementSearch::PlacementSearch(const PlacedShape& from, const PlacedShape& onto, bool reflected)
    : from_(from),
      onto_(onto),
      determinant_((reflected ? -1 : 1) * from.frame.axes.determinant() *
                   onto.frame.axes.determinant()) {}

// Two surfels: from the first to the second, and how their normals stand to that.
struct PlacementSearch::Chord {
  Chord(const Surfels& surfels, Index from, Index to);

  Index from, to;
  double length;
  Vector3 direction;
  double lean_from, lean_to;  // cosines, of either sign

  bool operator<(const Chord& other) const { return length < other.length; }
};

PlacementSearch::Chord::Chord(const Surfels& surfels, Index from, Index to) : from(from), to(to) {
  const Vector3 way = surfels[to].position - surfels[from].position;
  length = way.norm();
  direction = way / std::max(length, 1e-12);
  lean_from = std::abs(direction.dot(surfels[from].normal));
  lean_to = std::abs(direction.dot(surfels[to].normal));
}

// About so many.
std::vector<Index> PlacementSearch::flat_ones(const Surfels& surfels) {
  constexpr double least_flatness = 0.3;
  constexpr Index wanted = 250;
  std::vector<Index> flat;
  for (Index i = 0; i < surfels.size(); i += std::max<Index>(1, surfels.size() / wanted))
    if (surfels[i].flatness > least_flatness) flat.push_back(i);
  return flat;
}

// Those that lay two surfels on two others, normals included (Drost et al., Model globally,
// match locally, 2010); normals have either sign.
void PlacementSearch::add_laid_onto(const Chord& a, const Chord& b,
                                    std::vector<UnitPlacement>& all) const {
  constexpr double alike = 0.88;  // cosine, 28 degrees
  const Surfels &from = from_.coarse, &onto = onto_.coarse;
  const auto frame = [](const Chord& chord, const Vector3& normal) {
    Matrix3 axes;
    axes.col(0) = chord.direction;
    axes.col(1) = (normal - normal.dot(chord.direction) * chord.direction).stableNormalized();
    axes.col(2) = axes.col(0).cross(axes.col(1));
    return axes;
  };
  // The normal that leans less says more.
  const bool by_from = a.lean_from + b.lean_from < a.lean_to + b.lean_to;
  const Matrix3 own = frame(a, from[by_from ? a.from : a.to].normal);
  const Matrix3 other = frame(b, onto[by_from ? b.from : b.to].normal);
  for (const double sign : {1.0, -1.0}) {
    const Matrix3 turn =
        other * Vector3(1, sign, determinant_ * sign).asDiagonal() * own.transpose();
    if (std::abs((turn * from[a.from].normal).dot(onto[b.from].normal)) < alike ||
        std::abs((turn * from[a.to].normal).dot(onto[b.to].normal)) < alike)
      continue;
    all.push_back({map_taking(turn, (from[a.from].position + from[a.to].position) / 2,
                              (onto[b.from].position + onto[b.to].position) / 2)});
  }
}

std::vector<UnitPlacement> PlacementSearch::hypotheses(const Context& context) const {
  constexpr double shortest = 0.15;  // diagonals
  constexpr double leaning = 0.25;
  constexpr int tried = 400;
  constexpr std::size_t enough = 40'000;
  std::vector<UnitPlacement> all;
  // The principal frames: enough for whole shapes.
  for (const Vector3& signs :
       {Vector3(1, 1, 1), Vector3(1, -1, -1), Vector3(-1, 1, -1), Vector3(-1, -1, 1)})
    all.push_back({Eigen::Isometry3d(Matrix3((determinant_ * signs).asDiagonal()))});
  const std::vector<Index> own = flat_ones(from_.coarse), others = flat_ones(onto_.coarse);
  if (own.size() < 2) return all;
  std::vector<Chord> chords;
  for (const Index i : others)
    for (const Index j : others)
      if (const Chord b(onto_.coarse, i, j); b.length > shortest) chords.push_back(b);
  std::stable_sort(chords.begin(), chords.end());
  const double off = (from_.coarse.spacing() + onto_.coarse.spacing()) / 2;
  Random random(0);
  for (int trial = 0; trial < tried && all.size() < enough; ++trial) {
    context.check();
    const Chord a{from_.coarse, own[random.below(std::ssize(own))],
                  own[random.below(std::ssize(own))]};
    if (a.length < shortest) continue;
    const auto less = [](const Chord& b, double length) { return b.length < length; };
    for (auto b = std::lower_bound(chords.begin(), chords.end(), a.length - off, less);
         b != chords.end() && b->length < a.length + off; ++b)
      if (std::abs(a.lean_from - b->lean_from) < leaning &&
          std::abs(a.lean_to - b->lean_to) < leaning)
        add_laid_onto(a, *b, all);
  }
  return all;
}

MirrorFit PlacementSearch::fit(const UnitPlacement& placement, Index stride) const {
  const MirrorFit there = from_.score.fit(placement.map, onto_.score, stride),
                  back = onto_.score.fit(placement.map.inverse(), from_.score, stride);
  return {(there.share + back.share) / 2, (there.missing + back.missing) / 2,
          (there.exact + back.exact) / 2, (there.deviation + back.deviation) / 2};
}

double PlacementSearch::evidence(const UnitPlacement& placement) const {
  return (from_.score.evidence(placement.map, onto_.score) +
          onto_.score.evidence(placement.map.inverse(), from_.score)) /
         2;
}

UnitPlacement PlacementSearch::found(const Context& context) const {
  constexpr Index rough = 40, close = 4;
  constexpr double apart = 0.03;  // diagonals
  const std::vector<UnitPlacement> all = hypotheses(context.stage(0, 0.3));
  std::vector<Placement> candidates = best_of(all, from_.coarse, onto_.map, rough, context);
  if (candidates.empty()) candidates.push_back({all.front()});
  for (Placement& candidate : candidates) {
    context.check();
    candidate = refined_on_surfels(from_.coarse, onto_.map, candidate, 0.06, 0.015, 8, 3);
    candidate.support = fit(candidate.shape, 9).share;
  }
  suppress_non_maxima(from_.coarse, candidates, apart, close);
  for (Placement& candidate : candidates) {
    context.check();
    candidate.shape = from_.refinement.refined(candidate.shape, onto_.refinement);
    candidate.support = fit(candidate.shape, 3).share;
  }
  sort_best_first(candidates);
  return candidates.front().shape;
}

Matrix4 between_frames(const Eigen::Isometry3d& map, const PrincipalFrame& from,
                       const PrincipalFrame& onto) {
  const Matrix3 linear = onto.axes * map.linear() * from.axes.transpose();
  return map_taking(linear, from.centroid, onto.from_frame(map.translation())).matrix();
}

}  // namespace symsurf
