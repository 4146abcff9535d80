#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "base/parallel.h"
#include "cloud/cloud.h"
#include "cloud/voxel_grid.h"
#include "operations/meshes.h"

namespace symsurf {

namespace {

// Where pairs depend on faces: the positions of copies, of their partners and of what they are
// partners of.
std::vector<bool> positions_of_copies(const DistinctPoints& distinct,
                                      const std::vector<Index>& partners) {
  std::vector<bool> is_copied(distinct.first.size(), false), found;
  for (std::size_t i = 0; i < partners.size(); ++i)
    if (distinct.first[distinct.number[i]] != static_cast<Index>(i))
      is_copied[distinct.number[i]] = true;
  found = is_copied;
  for (std::size_t i = 0; i < partners.size(); ++i) {
    if (partners[i] < 0) continue;
    const std::int32_t here = distinct.number[i], there = distinct.number[partners[i]];
    if (is_copied[here]) found[there] = true;
    if (is_copied[there]) found[here] = true;
  }
  return found;
}

// Those of the faces that have a corner at given positions, by the positions of their corners.
class FacesByPosition {
 public:
  FacesByPosition(TrianglesView faces, const std::vector<std::int32_t>& position,
                  const std::vector<bool>& wanted)
      : rank_(faces.size(), -1) {
    for (Index f = 0; f < faces.size(); ++f) {
      const Triple corners{position[faces[f][0]], position[faces[f][1]], position[faces[f][2]]};
      if (std::none_of(corners.begin(), corners.end(), [&](Index p) { return wanted[p]; }))
        continue;
      std::vector<Index>& alike = of(corners);
      rank_[f] = static_cast<Index>(alike.size());
      alike.push_back(f);
    }
  }

  /// Which of the faces with the same corners and winding this is; -1: none of them.
  Index rank(Index face) const { return rank_[face]; }

  /// In their order.
  std::vector<Index>& of(Triple corners) {
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    const Index number = numbers_.add(corners);
    if (number == static_cast<Index>(faces_.size())) faces_.emplace_back();
    return faces_[number];
  }

 private:
  TripleIndex numbers_;
  std::vector<std::vector<Index>> faces_;
  std::vector<Index> rank_;
};

// Of each point the one that most of its faces' mirrored faces have at its place; -1 for none.
std::vector<Index> partners_by_faces(TrianglesView faces, const DistinctPoints& distinct,
                                     const std::vector<Index>& partners, const Context& context) {
  const std::vector<std::int32_t>& position = distinct.number;
  FacesByPosition by_position(faces, position, positions_of_copies(distinct, partners));
  std::vector<std::pair<Index, Index>> votes;
  interruptible_for(context, faces.size(), [&](Index f) {
    if (by_position.rank(f) < 0) return;
    const Index* corner = faces[f];
    Triple images;
    for (int c = 0; c < 3; ++c) {
      if (partners[corner[c]] < 0) return;
      images[c] = position[partners[corner[c]]];
    }
    // A mirror turns the winding round; a side that was mirrored by its points alone keeps it.
    const Triple turned{images[0], images[2], images[1]};
    const auto rank = static_cast<std::size_t>(by_position.rank(f));
    for (const Triple& corners : {turned, images}) {
      const std::vector<Index>& mirrored = by_position.of(corners);
      if (rank >= mirrored.size()) continue;
      for (int c = 0; c < 3; ++c)
        for (int k = 0; k < 3; ++k) {
          const Index partner = faces[mirrored[rank]][k];
          if (position[partner] == images[c]) votes.emplace_back(corner[c], partner);
        }
      return;
    }
  });
  std::sort(votes.begin(), votes.end());
  std::vector<Index> chosen(partners.size(), -1);
  std::vector<std::ptrdiff_t> most(partners.size(), 0);
  for (auto vote = votes.begin(); vote != votes.end();) {
    const auto end = std::find_if(vote, votes.end(), [&](const auto& v) { return v != *vote; });
    if (end - vote > most[vote->first]) {
      most[vote->first] = end - vote;
      chosen[vote->first] = vote->second;
    }
    vote = end;
  }
  return chosen;
}

}  // namespace

void pair_copies(PointsView points, TrianglesView faces, std::vector<Index>& partners,
                 const Context& context) {
  const DistinctPoints distinct = distinct_points(points, context);
  if (distinct.first.size() == distinct.number.size()) return;
  const std::vector<std::int32_t>& position = distinct.number;
  const std::vector<Index> by_faces = partners_by_faces(faces, distinct, partners, context);

  struct Copy {
    Index here, there;  // positions, of the point and of its partner
    Index point;
    bool operator<(const Copy& other) const {
      return std::tie(here, there, point) < std::tie(other.here, other.there, other.point);
    }
  };
  std::vector<Copy> left;
  for (std::size_t i = 0; i < partners.size(); ++i) {
    if (partners[i] < 0) continue;
    const auto point = static_cast<Index>(i);
    const Index other = by_faces[i];
    if (other >= 0 && by_faces[other] == point)
      partners[i] = other;
    else
      left.push_back({position[i], position[partners[i]], point});
  }
  std::sort(left.begin(), left.end());
  for (auto copy = left.begin(); copy != left.end();) {
    const auto end = std::find_if(copy, left.end(), [&](const Copy& other) {
      return other.here != copy->here || other.there != copy->there;
    });
    auto other = std::lower_bound(left.begin(), left.end(), Copy{copy->there, copy->here, -1});
    for (; copy != end; ++copy) {
      const bool is_back =
          other != left.end() && other->here == copy->there && other->there == copy->here;
      if (is_back)
        partners[copy->point] = (other++)->point;
      else if (by_faces[copy->point] >= 0)
        partners[copy->point] = by_faces[copy->point];
    }
  }
}

}  // namespace symsurf
