// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <symsurf/result.h>
#include <symsurf/synthetic.h>

#include <memory>

#include "cloud_conversion.h"
#include "meshlab_host.h"

namespace symsurf::meshlab {

/// Adds the layer "Mirror": the mirror's triangles, placed like `input`, and the mirror itself for
/// mirror_of(). The numbers are the mirror's until somebody moves a vertex.
MeshModel& add_mirror_layer(MeshDocument& document, const MeshModel& input,
                            std::shared_ptr<const Mirror> mirror, const Mesh& mesh);

/// Adds a layer like "Candidate mirror 1, score 0.98" for another mirror of the result, which
/// mirror_of() gives back as it does the best one.
MeshModel& add_candidate_layer(MeshDocument& document, const MeshModel& input, std::size_t rank,
                               const Result& candidate, const Mesh& mesh);

/// The mirror that add_mirror_layer() left in a layer. In any other layer, such as one that was
/// saved and read again, the plane or the sphere that its vertices lie on, or null.
std::shared_ptr<const Mirror> mirror_of(const MeshModel& layer);

/// Whether it looks like a layer of add_mirror_layer(), the one to offer first.
bool is_mirror_layer(const MeshModel& layer);

/// Adds the layer "Surface points": the result's, with their residuals as quality.
MeshModel& add_surface_points_layer(MeshDocument& document, const MeshModel& input,
                                    const Result& result);

/// Adds the layer "Sample": the points, each with its partner as attribute "partner", or -1.
MeshModel& add_sample_layer(MeshDocument& document, const Sample& sample);

/// Marks each vertex of the layer: quality = residual, with MeshLab's colour ramp from 0 to the
/// largest; attribute "partner" = the vertex its image falls on; attribute "side" = -1, 0 or 1, the
/// side of the mirror it is on. Vertices without a partner, and those not looked at, are grey with
/// quality and partner -1. `distances`: the points' from the mirror, signed; empty without a
/// mirror.
void mark_asymmetry(MeshModel& layer, const LayerCloud& cloud, const Result& result,
                    const Eigen::VectorXd& distances);

}  // namespace symsurf::meshlab
