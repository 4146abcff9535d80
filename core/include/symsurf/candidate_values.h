#pragma once

#include <symsurf/result.h>

namespace symsurf {

/// The numbers of a result's candidates, one row a candidate, best first: "candidate_scores" (n, 1)
/// and, where all are planes, "candidate_normals" (n, 3) and "candidate_offsets" (n, 1). None where
/// there are no candidates.
Values candidate_values(const Result& result);

}  // namespace symsurf
