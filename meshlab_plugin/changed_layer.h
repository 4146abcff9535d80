// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <symsurf/attributes.h>

#include "meshlab_host.h"

namespace symsurf::meshlab {

/// Lays the layer's vertices where the result has them and appends what it adds, which is then
/// what is selected; added vertices and faces have the attributes of their sources, those with
/// directions as the transform of the result turns them. Vertices whose place is not finite stay
/// where they are, and are what is selected. The layer is the input of the result, without deleted
/// vertices and faces.
void change_layer(MeshModel& layer, const OperationResult& result, const AttributeTransform& by);

}  // namespace symsurf::meshlab
