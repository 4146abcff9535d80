#pragma once

#include "search/methods.h"

// Methods as their authors describe them: those of the thesis, and baselines.

namespace symsurf {

MethodImplementation separation_method();
MethodImplementation separation_normals_method();
MethodImplementation normals_only_method();
MethodImplementation sphere_thesis_method();
MethodImplementation plane_icp_method();
MethodImplementation plane_svd_method();
MethodImplementation plane_hruda_method();

}  // namespace symsurf
