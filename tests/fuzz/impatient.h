#pragma once

#include <symsurf/context.h>

#include <ctime>

#include "draw.h"

namespace symsurf {

inline double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// A context of one thread that cancels: most calls after 10 ms of the processor, that there are
/// many, one in 64 after 2 s, by when most have come to their end.
inline Context impatient(Source& source) {
  const double end = processor_seconds() + (one_in(source, 64) ? 2 : 0.01);
  return Context([end](double) { return processor_seconds() < end; }, 1);
}

}  // namespace symsurf
