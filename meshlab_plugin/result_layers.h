// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <symsurf/analyses.h>
#include <symsurf/detect.h>
#include <symsurf/synthetic.h>

#include <memory>
#include <string>

#include "meshlab_host.h"

namespace symsurf::meshlab {

/// The layers that a filter leaves beside its input, placed like it. They take the place of those
/// that it left for the same input before, but for layers that somebody gave another name. The
/// input is, or becomes where layers are removed, the current layer.
class ResultLayers {
 public:
  ResultLayers(MeshDocument& document, const MeshModel& input, std::string filter);

  /// Adds the layer "Mirror", which mirror_of() reads.
  MeshModel& add_mirror(std::shared_ptr<const Mirror> mirror, const Mesh& mesh);

  /// Adds a layer like "Candidate mirror 1, score 0.98" for another mirror of the result, which
  /// mirror_of() gives back as it does the best one.
  MeshModel& add_candidate(std::size_t rank, const Result& candidate, const Mesh& mesh);

  /// Adds a layer like "Symmetry plane 1", which mirror_of() reads, too.
  MeshModel& add_plane(std::size_t number, const Plane& plane);

  /// Adds the layer "Symmetry axes": an edge for each axis of rotation.
  MeshModel& add_axes(const AnalysisResult& result);

  /// Adds the layer "Surface points": the result's, with their residuals as quality. Hidden where
  /// there is a mirror to see.
  MeshModel& add_surface_points(const Result& result);

 private:
  MeshModel& add(const QString& name);

  MeshDocument& document_;
  const MeshModel& input_;
  std::string filter_;
};

/// Whether a filter left the layer beside that input.
bool is_result_of(const MeshModel& layer, const MeshModel& input);

/// The layer of the mirror last found for the input; null where there is none.
const MeshModel* last_mirror_layer(const MeshDocument& document, const MeshModel& input);

/// Moves what filters left beside the input along with it.
void move_results(MeshDocument& document, const MeshModel& input, const Matrix4& rigid);

/// Adds the layer "Sample": the points, each with its partner as attribute "partner", or -1.
MeshModel& add_sample_layer(MeshDocument& document, const Sample& sample);

}  // namespace symsurf::meshlab
