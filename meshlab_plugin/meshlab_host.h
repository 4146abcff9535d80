// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// MeshLab as this plugin sees it. Written for 2025.07; what 2022.02 names otherwise gets its later
// name here.

#include <common/plugins/interfaces/filter_plugin.h>

#if !__has_include(<common/parameters/rich_parameters.h>)
using RichPercentage = RichAbsPerc;
#endif
