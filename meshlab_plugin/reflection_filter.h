// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "filter.h"

namespace symsurf::meshlab {

/// Mirrors the current layer over a mirror that one of the detection filters found.
class ReflectionFilter final : public Filter {
 public:
  std::string title() const override { return "Reflect over a mirror"; }
  std::string python_name() const override { return "apply_mirror_reflection"; }
  std::string info() const override;
  FilterPlugin::FilterClass menus() const override;
  FilterPlugin::FilterArity arity() const override { return FilterPlugin::FIXED; }
  int changes() const override { return MeshModel::MM_VERTNUMBER | MeshModel::MM_FACENUMBER; }
  RichParameterList parameters(const MeshDocument& document) const override;
  Outcome apply(const RichParameterList& parameters, MeshDocument& document,
                const Context::Progress& progress) const override;
};

}  // namespace symsurf::meshlab
