#pragma once

#include "operations/operation.h"

namespace symsurf {

OperationImplementation remesh_operation();
OperationImplementation cut_operation();

}  // namespace symsurf
