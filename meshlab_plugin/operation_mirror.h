// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <symsurf/operations.h>

#include <memory>
#include <string>
#include <vector>

#include "cloud_conversion.h"
#include "meshlab_host.h"

namespace symsurf::meshlab {

/// The mirror of an operation on a layer, in that layer's coordinates: what another layer holds, or
/// found first.
class OperationMirror {
 public:
  /// The mirror of the layer `holder`; for the operation's parameter "back" the curved one, where
  /// that was laid flat into the mirror that the layer holds now. Throws what mirror_beside() does.
  OperationMirror(const MeshModel& layer, MeshModel& holder, const Values& parameters);

  /// Finds it with the method `auto`. Throws what found_mirror() does.
  OperationMirror(const LayerCloud& cloud, bool require_found, const Context& context);

  const Mirror& operator*() const { return *mirror_; }

  /// How it was found, and a warning where the verdict is "none", for the log; empty for that of a
  /// layer.
  const std::vector<std::string>& log() const { return log_; }

  /// Adds the layer of a mirror that was found, and brings the mirrors of a moved shape along with
  /// it: turned as it is, laid flat, or bent again. Gives the layer that holds the mirror.
  const MeshModel& place(MeshDocument& document, const MeshModel& layer,
                         const OperationResult& result) const;

 private:
  std::shared_ptr<const Mirror> mirror_;
  MeshModel* holder_ = nullptr;  // none: found
  std::vector<std::string> log_;
};

}  // namespace symsurf::meshlab
