// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <symsurf/attributes.h>

#include <map>
#include <string>

#include "meshlab_host.h"

namespace symsurf::meshlab {

/// What a layer's vertices have with directions: attributes of three numbers, which are vectors,
/// and the normals of a cloud; those of a mesh its faces give anew.
class Directions {
 public:
  explicit Directions(CMeshO& mesh);

  void carry(const AttributeTransform& by);

  /// Gives them to the vertices, one a row.
  void set(CMeshO& mesh) const;

 private:
  Eigen::MatrixXd normals_;  // none of a mesh
  std::map<std::string, Eigen::MatrixXd> vectors_;
};

}  // namespace symsurf::meshlab
