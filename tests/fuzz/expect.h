#pragma once

#include <symsurf/context.h>

#include <cstdio>
#include <cstdlib>

namespace symsurf {

/// Ends the process, which libFuzzer takes for a finding, where a result is wrong.
inline void expect(bool is_so, const char* what) {
  if (is_so) return;
  std::fprintf(stderr, "not so: %s\n", what);
  std::abort();
}

/// Runs the call, which may throw what the headers document; any other exception is a finding.
/// False where it has thrown.
template <typename Call>
bool runs(const Call& call) {
  try {
    call();
    return true;
  } catch (const InvalidInput&) {
    return false;
  } catch (const InvalidParameter&) {
    return false;
  } catch (const Cancelled&) {
    return false;
  }
}

}  // namespace symsurf
