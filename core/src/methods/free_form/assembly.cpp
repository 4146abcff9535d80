#include "methods/free_form/assembly.h"

#include <algorithm>

namespace symsurf::perpendicular {

namespace {

constexpr int last_rounds = 8;
constexpr std::size_t most_refined = 3;
constexpr double worth_refining = 0.7;  // of the best rank

// Of mirrors that explain about the same the curved one comes first: planes have their own method.
double rank(const Sheet& sheet) { return (is_flat(sheet) ? 0.85 : 1) * sheet.explained; }
bool ranks_higher(const Sheet& a, const Sheet& b) { return rank(a) > rank(b); }

// How well the points that a sheet carries land.
double precision(const SearchCloud& cloud, const Sheet& sheet) {
  return sheet.explained * static_cast<double>(cloud.size()) /
         static_cast<double>(sheet.carried.size());
}

// The side of the sheet a point is on: 1, -1 or 0 for a point that the sheet does not carry.
std::vector<signed char> sides(const SearchCloud& cloud, const Sheet& sheet) {
  std::vector<signed char> side(cloud.size(), 0);
  for (std::size_t k = 0; k < sheet.points.size(); ++k)
    side[sheet.points[k]] = sheet.carried[k].distance > 0 ? 1 : -1;
  return side;
}

// The sum of agreeing less disagreeing sides between neighbours, one in each sheet.
int agreement(const SearchCloud& cloud, const std::vector<signed char>& a,
              const std::vector<signed char>& b) {
  int votes = 0;
  for (Index i = 0; i < cloud.size(); ++i) {
    if (a[i] == 0) continue;
    for (int k = 0; k < SearchCloud::ring; ++k) votes += a[i] * b[cloud.neighbours(i, k)];
  }
  return votes;
}

// Adds what `piece` carries and `whole` does not; false when that is too little.
bool add(const SearchCloud& cloud, const Sheet& piece, Sheet& whole) {
  const std::vector<signed char> mine = sides(cloud, whole), other = sides(cloud, piece);
  std::vector<std::size_t> gained;
  for (std::size_t k = 0; k < piece.points.size(); ++k)
    if (mine[piece.points[k]] == 0) gained.push_back(k);
  if (static_cast<double>(gained.size()) < 0.03 * static_cast<double>(cloud.size()) ||
      2 * gained.size() < piece.points.size())
    return false;
  const double turn = agreement(cloud, mine, other) < 0 ? -1 : 1;
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

Sheet whole_from(const SearchCloud& cloud, const std::vector<Sheet>& sheets, std::size_t first) {
  Sheet whole = sheets[first];
  bool grown = false;
  for (std::size_t k = 0; k < sheets.size(); ++k) {
    if (k == first || sheets[k].exact != whole.exact) continue;
    if (precision(cloud, sheets[k]) < 0.8 * precision(cloud, sheets[first])) continue;
    grown = add(cloud, sheets[k], whole) || grown;
  }
  if (grown) whole.mirror = nullptr;
  return whole;
}

}  // namespace

std::vector<Sheet> assemble(const SearchCloud& cloud, std::vector<Sheet> sheets,
                            const Context& context) {
  std::stable_sort(sheets.begin(), sheets.end(), ranks_higher);
  std::vector<Sheet> wholes;
  for (std::size_t k = 0; k < std::min(sheets.size(), most_refined); ++k) {
    context.report(static_cast<double>(k) / most_refined);
    if (rank(sheets[k]) < worth_refining * rank(sheets[0])) break;
    if (sheets[k].bent && !sheets[k].exact) {
      wholes.push_back(sheets[k]);
      continue;
    }
    Sheet whole = whole_from(cloud, sheets, k);
    refine(cloud, last_rounds, whole);
    wholes.push_back(whole.mirror && whole.explained > sheets[k].explained ? std::move(whole)
                                                                           : sheets[k]);
  }
  for (std::size_t k = wholes.size(); k < sheets.size(); ++k)
    wholes.push_back(std::move(sheets[k]));
  std::stable_sort(wholes.begin(), wholes.end(), ranks_higher);
  return wholes;
}

}  // namespace symsurf::perpendicular
