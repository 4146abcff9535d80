// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <symsurf/analyses.h>

#include "filter.h"

namespace symsurf::meshlab {

/// One of the core's analyses in the menu: finds symmetries of the current layer other than one
/// mirror.
class AnalysisFilter final : public Filter {
 public:
  /// The analysis must outlive the filter, as those of analyses() do.
  explicit AnalysisFilter(const Analysis& analysis) : analysis_(analysis) {}

  std::string title() const override { return analysis_.title; }
  std::string python_name() const override { return "compute_" + analysis_.name; }
  std::string info() const override;
  FilterPlugin::FilterClass menus() const override;
  FilterPlugin::FilterArity arity() const override { return FilterPlugin::SINGLE_MESH; }
  int changes() const override;
  RichParameterList parameters(const MeshDocument& document) const override;
  Outcome apply(const RichParameterList& parameters, MeshDocument& document,
                const Context::Progress& progress) const override;

 private:
  const Analysis& analysis_;
};

}  // namespace symsurf::meshlab
