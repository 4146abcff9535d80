#pragma once

#include <vector>

#include "methods/free_form/hermite_fit.h"
#include "methods/free_form/search_cloud.h"
#include "methods/free_form/seeds.h"

namespace symsurf::perpendicular {

/// A coherent surface of oriented midpoints while it grows outwards from one pair.
class Growth {
 public:
  Growth(const SearchCloud& cloud, const Seed& seed);

  /// Rings of points around what is known, until nothing more fits or `most` points do.
  void grow(Index most);

  /// Carries every accepted point over its own patch and fits the patches again.
  void refine();

  /// Points that have found a partner, in the order found.
  const std::vector<std::int32_t>& accepted() const { return accepted_; }
  std::int32_t partner(Index i) const { return partner_[i]; }
  const Patch& patch(Index i) const { return patches_[patch_of_[i]]; }
  const Carried& carried(Index i) const { return carried_[patch_of_[i]]; }

  /// Of the accepted points, in the mean.
  double closeness() const;
  /// Whether the partners are the images themselves, as of the last refine().
  bool exact() const { return exact_; }

 private:
  bool carry(std::int32_t i, const Patch& guide, Carried& carried, std::int32_t& partner) const;
  bool accept(std::int32_t i, const Patch& guide);
  void guide_neighbours(std::int32_t i);
  void refit(std::int32_t i);
  double nearest_squared(std::int32_t i, std::int32_t by) const;

  const SearchCloud* cloud_;
  std::vector<std::int32_t> accepted_, frontier_;
  std::vector<std::int32_t> partner_, guide_, patch_of_;
  std::vector<std::int32_t> slot_of_;  // in the data of the latest patch fitted to them
  std::vector<char> tries_;
  std::vector<Patch> patches_;
  std::vector<Carried> carried_;
  bool exact_ = false;
  double along_ = 0.3;
  std::size_t fresh_ = 0;  // accepted_ from here on have not guided their neighbours yet
};

}  // namespace symsurf::perpendicular
