// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <symsurf/mirror.h>

#include <memory>

#include "meshlab_host.h"

namespace symsurf::meshlab {

/// Makes the layer one of a mirror: its triangles, and the mirror itself for mirror_of(). The
/// numbers are the mirror's until somebody moves a vertex. `bent`: the curved mirror that was
/// laid flat into this one, if it was.
void draw_mirror(MeshModel& layer, std::shared_ptr<const Mirror> mirror, const Mesh& mesh,
                 std::shared_ptr<const Mirror> bent = nullptr);

/// The mirror that draw_mirror() left in a layer. In any other layer, such as one that was saved
/// and read again, the plane or the sphere that its vertices lie on, or null.
std::shared_ptr<const Mirror> mirror_of(const MeshModel& layer);

/// The same; throws InvalidParameter in place of null.
std::shared_ptr<const Mirror> mirror_in(const MeshModel& layer);

/// mirror_in() where MeshLab shows it beside another layer: in that one's coordinates. Throws
/// InvalidParameter also where the transforms of the two differ by more than a similarity.
std::shared_ptr<const Mirror> mirror_beside(const MeshModel& layer, const MeshModel& holder);

/// The curved mirror that was laid flat into the one of the layer; null where none was.
std::shared_ptr<const Mirror> bent_mirror_of(const MeshModel& layer);

/// Turns and shifts the layer with the mirror that it holds.
void move_layer(MeshModel& layer, const Matrix4& rigid);

/// Whether it looks like a layer of a mirror, the one to offer first.
bool is_mirror_layer(const MeshModel& layer);

/// What such a layer is called.
inline constexpr const char* mirror_layer_name = "Mirror";

/// Appends the choice of the layer that the mirror is taken from.
void add_mirror_choice(RichParameterList& dialog, const MeshDocument& document, int default_layer,
                       const QString& tooltip);

/// The layer chosen. Throws InvalidParameter where there is no such layer any more.
MeshModel& chosen_mirror_layer(const RichParameterList& dialog, MeshDocument& document);

/// Appends the choice of the layer of the second of two shapes.
void add_other_choice(RichParameterList& dialog, const MeshDocument& document);

/// Appends the choice of the layer of landmarks, and how well they are placed.
void add_landmarks_choice(RichParameterList& dialog, const MeshDocument& document);

/// Their vertices by twos, where MeshLab shows them beside a layer: OperationInput::landmark_pairs
/// without deviations. None where the layer itself is chosen.
Eigen::MatrixXd chosen_landmarks(const RichParameterList& dialog, MeshDocument& document,
                                 const MeshModel& layer);

/// Throws InvalidParameter where the document has no such layer.
MeshModel& chosen_other_layer(const RichParameterList& dialog, MeshDocument& document);

}  // namespace symsurf::meshlab
