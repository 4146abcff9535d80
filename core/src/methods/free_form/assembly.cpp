#include "methods/free_form/assembly.h"

#include <algorithm>

namespace symsurf::perpendicular {

namespace {

constexpr int last_rounds = 8;
constexpr std::size_t most_refined = 3;
constexpr double worth_refining = 0.7;  // of the best rank

// Of mirrors that explain about the same the curved one comes first: planes have their own method.
double rank(const GrownSurface& surface) { return (is_flat(surface) ? 0.85 : 1) * surface.support; }
bool ranks_higher(const GrownSurface& a, const GrownSurface& b) { return rank(a) > rank(b); }

// How well the points that a surface carries land.
double precision(const SearchCloud& cloud, const GrownSurface& surface) {
  return surface.support * static_cast<double>(cloud.size()) /
         static_cast<double>(surface.carried.size());
}

// The side of the surface a point is on: 1, -1 or 0 for a point that the surface does not carry.
std::vector<signed char> sides(const SearchCloud& cloud, const GrownSurface& surface) {
  std::vector<signed char> side(cloud.size(), 0);
  for (std::size_t k = 0; k < surface.points.size(); ++k)
    side[surface.points[k]] = surface.carried[k].distance > 0 ? 1 : -1;
  return side;
}

// The sum of agreeing less disagreeing sides between neighbours, one in each surface.
int correspondence(const SearchCloud& cloud, const std::vector<signed char>& a,
                   const std::vector<signed char>& b) {
  int votes = 0;
  for (Index i = 0; i < cloud.size(); ++i) {
    if (a[i] == 0) continue;
    for (int k = 0; k < SearchCloud::ring; ++k) votes += a[i] * b[cloud.neighbours(i, k)];
  }
  return votes;
}

// Adds what `piece` carries and `whole` does not; false when that is too little.
bool add(const SearchCloud& cloud, const GrownSurface& piece, GrownSurface& whole) {
  const std::vector<signed char> mine = sides(cloud, whole), other = sides(cloud, piece);
  std::vector<std::size_t> gained;
  for (std::size_t k = 0; k < piece.points.size(); ++k)
    if (mine[piece.points[k]] == 0) gained.push_back(k);
  if (static_cast<double>(gained.size()) < 0.03 * static_cast<double>(cloud.size()) ||
      2 * gained.size() < piece.points.size())
    return false;
  const double turn = correspondence(cloud, mine, other) < 0 ? -1 : 1;
  for (const std::size_t k : gained) {
    Carried c = piece.carried[k];
    c.normal *= turn;
    c.distance *= turn;
    whole.carried.push_back(c);
    whole.points.push_back(piece.points[k]);
    whole.partners.push_back(piece.partners[k]);
  }
  return true;
}

GrownSurface whole_from(const SearchCloud& cloud, const std::vector<GrownSurface>& surfaces,
                        std::size_t first) {
  GrownSurface whole = surfaces[first];
  bool grown = false;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    if (k == first || surfaces[k].exact != whole.exact) continue;
    if (precision(cloud, surfaces[k]) < 0.8 * precision(cloud, surfaces[first])) continue;
    grown = add(cloud, surfaces[k], whole) || grown;
  }
  if (grown) whole.mirror = nullptr;
  return whole;
}

}  // namespace

std::vector<GrownSurface> assemble(const SearchCloud& cloud, std::vector<GrownSurface> surfaces,
                                   const Context& context) {
  std::stable_sort(surfaces.begin(), surfaces.end(), ranks_higher);
  std::vector<GrownSurface> wholes;
  for (std::size_t k = 0; k < std::min(surfaces.size(), most_refined); ++k) {
    context.report(static_cast<double>(k) / most_refined);
    if (rank(surfaces[k]) < worth_refining * rank(surfaces[0])) break;
    if (surfaces[k].bent && !surfaces[k].exact) {
      wholes.push_back(surfaces[k]);
      continue;
    }
    GrownSurface whole = whole_from(cloud, surfaces, k);
    refine(cloud, last_rounds, whole);
    wholes.push_back(whole.mirror && whole.support > surfaces[k].support ? std::move(whole)
                                                                         : surfaces[k]);
  }
  for (std::size_t k = wholes.size(); k < surfaces.size(); ++k)
    wholes.push_back(std::move(surfaces[k]));
  std::stable_sort(wholes.begin(), wholes.end(), ranks_higher);
  return wholes;
}

}  // namespace symsurf::perpendicular
