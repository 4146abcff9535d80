// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <symsurf/points.h>

#include <vector>

#include "meshlab_host.h"

namespace symsurf::meshlab {

/// The vertices of a layer as the core takes them, in the layer's own coordinates: its transform is
/// not applied.
struct LayerCloud {
  Points points;            ///< one row a vertex; deleted vertices have none
  Points normals;           ///< the same rows; none unless asked for
  std::vector<int> vertex;  ///< the vertex each row came from
  Triangles faces;          ///< between the rows; none unless asked for
};

/// A row as MeshLab's vertices have it.
inline Point3m to_point(const Points& points, Index row) {
  return Point3m(points(row, 0), points(row, 1), points(row, 2));
}

/// The layer that filters work on. Throws InvalidInput where the document has none.
MeshModel& current_layer(MeshDocument& document);

/// The layer's bounding box's diagonal, what MeshLab shows lengths as percentages of; 1 where there
/// is no box, or none whose percentages single precision holds.
double layer_diagonal(const MeshModel* layer);

/// Packs a layer, or of it the selected vertices and the corners of selected faces.
/// Throws InvalidInput for a layer without vertices or selection, and for normals asked of a layer
/// whose normals are all zero, which is how MeshLab says that there are none.
LayerCloud read_cloud(const MeshModel& layer, bool only_selected, bool with_normals,
                      bool with_faces = false);

/// Red, green and blue of each row of the cloud, 0 to 255; none where the layer has no colours.
Points read_colours(const MeshModel& layer, const LayerCloud& cloud);

/// How far each row of the cloud may move, 0 to 1: only what is selected, or by the vertices'
/// quality, or both; empty for neither.
/// Throws InvalidInput for a layer without a selection, where that is asked for.
Eigen::VectorXd read_mask(const MeshModel& layer, const LayerCloud& cloud, bool only_selected,
                          bool by_quality);

}  // namespace symsurf::meshlab
