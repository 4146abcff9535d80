#pragma once

// The mirrors of few numbers that are searched for: each a `Shape` as candidate.h describes it.
#include "../cylinder/cylinder_step.h"
#include "../plane/plane_step.h"
#include "../sphere/sphere_step.h"
