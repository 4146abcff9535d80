#pragma once

#include <cstdint>

namespace symsurf::benchmarks {

/// How much the process has taken at most since this object was made, beyond what it held then.
class PeakMemory {
 public:
  PeakMemory();
  std::int64_t bytes() const;

 private:
  std::int64_t before_;
};

}  // namespace symsurf::benchmarks
