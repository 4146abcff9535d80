// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "filter.h"

namespace symsurf::meshlab {

/// Makes points of a known mirror, by one of the core's generators.
class SampleFilter final : public Filter {
 public:
  std::string title() const override { return "Mirror sample"; }
  std::string python_name() const override { return "create_mirror_sample"; }
  std::string info() const override;
  FilterPlugin::FilterClass menus() const override { return FilterPlugin::MeshCreation; }
  FilterPlugin::FilterArity arity() const override { return FilterPlugin::NONE; }
  int changes() const override { return MeshModel::MM_VERTNUMBER | MeshModel::MM_FACENUMBER; }
  RichParameterList parameters(const MeshDocument& document) const override;
  Outcome apply(const RichParameterList& parameters, MeshDocument& document,
                const Context::Progress& progress) const override;
};

}  // namespace symsurf::meshlab
