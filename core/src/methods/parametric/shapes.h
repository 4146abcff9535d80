#pragma once

// The mirrors of few numbers that are searched for: each a `Shape` as candidate.h describes it.
#include "methods/parametric/cylinder_step.h"
#include "methods/parametric/plane_step.h"
#include "methods/parametric/sphere_step.h"
