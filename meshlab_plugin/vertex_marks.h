// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <symsurf/analyses.h>
#include <symsurf/detect.h>
#include <symsurf/operations.h>

#include "cloud_conversion.h"
#include "meshlab_host.h"

namespace symsurf::meshlab {

/// Colours the vertices by their quality, which are these residuals: MeshLab's ramp, from blue for
/// none over green to red for the largest.
void colour_by_residual(MeshModel& layer, const Eigen::VectorXd& residuals);

/// Marks each vertex of the layer: quality = residual, coloured; attribute "partner" = the vertex
/// its image falls on; attribute "side" = -1, 0 or 1, the side of the mirror it is on. Vertices
/// without a partner, and those not looked at, are grey with quality and partner -1. `distances`:
/// the points' from the mirror, signed; empty without a mirror.
void mark_residuals(MeshModel& layer, const LayerCloud& cloud, const Result& result,
                    const Eigen::VectorXd& distances);

/// Gives the vertices an operation's arrays as attributes of the same names: numbers of type
/// Scalarm, or Point3m. Rows of the result are vertices: none is deleted.
void add_attributes(MeshModel& layer, const OperationResult& result);

/// Shows what an operation says about each vertex as quality, coloured: the signed asymmetry from
/// blue over green, none, to red, as far to both sides; the confidence, blue for the best; or the
/// irradiance, blue for none.
/// Vertices of which it says nothing are grey with quality 0.
void show_as_quality(MeshModel& layer, const OperationResult& result);

/// Gives the vertices what an analysis says of each as attributes of the same names, and shows the
/// array that the analysis is to be seen by as quality, coloured from blue for the least to red.
/// Vertices of which it says nothing, and those not looked at, are grey.
void mark_analysed(MeshModel& layer, const LayerCloud& cloud, const AnalysisResult& result);

}  // namespace symsurf::meshlab
