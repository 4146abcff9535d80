// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <symsurf/parameter.h>

#include <vector>

#include "meshlab_host.h"

namespace symsurf::meshlab {

/// What several filters ask beside the core's parameters.
Parameter only_selected_parameter();
Parameter threads_parameter();

/// Appends an entry for each described parameter, in order. Those in units of the diagonal become
/// percentages of `diagonal`. Advanced ones MeshLab folds away.
void add_parameters(RichParameterList& dialog, const std::vector<Parameter>& described,
                    double diagonal);

/// What the dialog says about the described parameters, in the core's types and units; the core
/// checks the ranges. MeshLab carries numbers as 32-bit floats, so a number is read as the shortest
/// decimal which that float stands for: 0.05 arrives as 0.05.
/// Throws InvalidParameter for a choice that is not on the list.
Values read_parameters(const RichParameterList& dialog, const std::vector<Parameter>& described,
                       double diagonal);

}  // namespace symsurf::meshlab
