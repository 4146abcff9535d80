// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <symsurf/detect.h>

#include "filter.h"

namespace symsurf::meshlab {

/// One of the core's methods in the menu: finds the current layer's mirror.
class DetectionFilter final : public Filter {
 public:
  /// The method must outlive the filter, as those of methods() do.
  explicit DetectionFilter(const Method& method) : method_(method) {}

  std::string title() const override { return method_.title; }
  std::string python_name() const override { return "compute_mirror_" + method_.name; }
  std::string info() const override;
  FilterPlugin::FilterClass menus() const override;
  FilterPlugin::FilterArity arity() const override { return FilterPlugin::SINGLE_MESH; }
  int changes() const override;
  RichParameterList parameters(const MeshDocument& document) const override;
  Outcome apply(const RichParameterList& parameters, MeshDocument& document,
                const Context::Progress& progress) const override;

 private:
  const Method& method_;
};

}  // namespace symsurf::meshlab
