#ifndef core_call_h
#define core_call_h

#include <symsurf/context.h>
#include <symsurf/parameter.h>

#include "vtkAlgorithm.h"
#include "vtkVersionMacros.h"

/// Progress, abort and threads of a filter as the core wants them.
inline symsurf::Context context_of(vtkAlgorithm* filter, int threads = 0) {
  return symsurf::Context(
      [filter](double fraction) {
        filter->UpdateProgress(fraction);
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20220823)
        if (filter->CheckAbort()) return false;
#endif
        return filter->GetAbortExecute() == 0;
      },
      threads);
}

/// Warns of points that were left out, and of what the core warns of.
inline void warn_of(vtkAlgorithm* filter, const symsurf::Values& statistics) {
  const auto count = statistics.find("nonfinite_points");
  if (count != statistics.end())
    vtkWarningWithObjectMacro(
        filter, << symsurf::to_string(count->second) << " points are not finite and were left out");
  const auto warning = statistics.find("warning");
  if (warning != statistics.end())
    vtkWarningWithObjectMacro(filter, << symsurf::to_string(warning->second));
}

/// Runs a call of the core inside RequestData and gives what RequestData has to return. Errors of
/// the core become errors of the filter; an abort is none.
template <typename Call>
int core_call(vtkAlgorithm* filter, const Call& call) {
  try {
    call();
    return 1;
  } catch (const symsurf::Cancelled&) {
    return 1;
  } catch (const std::exception& error) {
    vtkErrorWithObjectMacro(filter, << error.what());
    return 0;
  }
}

#endif
