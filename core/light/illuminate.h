#pragma once

#include "operations/operation.h"

namespace symsurf {

OperationImplementation illuminate_operation();

}  // namespace symsurf
