#pragma once

#include <algorithm>
#include <vector>

namespace symsurf {

/// Keeps the k least of what it is given, least first. Whether the candidate is one of them.
template <typename T>
bool keep_best(std::vector<T>& found, std::size_t k, const T& candidate) {
  const bool full = found.size() == k;
  if (full && !(candidate < found.back())) return false;
  if (full) found.pop_back();
  found.insert(std::upper_bound(found.begin(), found.end(), candidate), candidate);
  return true;
}

}  // namespace symsurf
