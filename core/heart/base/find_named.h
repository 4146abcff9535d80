#pragma once

#include <symsurf/context.h>

#include <string>
#include <string_view>
#include <vector>

namespace symsurf {

/// The item of that name. Throws InvalidParameter, listing the names there are; `what`: "method".
template <typename Item>
const Item& find_named(const std::vector<Item>& items, std::string_view name, const char* what) {
  std::string names;
  for (const Item& item : items) {
    if (item.name == name) return item;
    names += (names.empty() ? "" : ", ") + item.name;
  }
  throw InvalidParameter("there is no " + std::string(what) + " '" + std::string(name) +
                         "'; there are " + names);
}

}  // namespace symsurf
