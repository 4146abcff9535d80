#pragma once

#include <symsurf/operations.h>

#include <string>
#include <variant>

namespace symsurf {

inline double figure(const OperationResult& result, const std::string& name) {
  return std::get<double>(result.statistics.at(name));
}

}  // namespace symsurf
