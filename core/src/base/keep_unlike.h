#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace symsurf {

/// Of items that stand best first, keeps the first `count` that are not alike(item, kept) to one
/// kept before.
template <typename Item, typename Alike>
void keep_unlike(std::vector<Item>& items, std::size_t count, const Alike& alike) {
  std::vector<Item> kept;
  for (Item& item : items) {
    if (kept.size() == count) break;
    const bool is_new = std::none_of(kept.begin(), kept.end(),
                                     [&](const Item& other) { return alike(item, other); });
    if (is_new) kept.push_back(std::move(item));
  }
  items = std::move(kept);
}

}  // namespace symsurf
