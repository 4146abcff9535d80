// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <symsurf/operations.h>

#include "filter.h"

namespace symsurf::meshlab {

/// One of the core's operations in the menu: does it to the current layer, over the mirror of a
/// layer or one that it finds first.
class OperationFilter final : public Filter {
 public:
  /// The operation must outlive the filter, as those of operations() do.
  explicit OperationFilter(const Operation& operation) : operation_(operation) {}

  std::string title() const override { return operation_.title; }
  std::string python_name() const override;
  std::string info() const override;
  FilterPlugin::FilterClass menus() const override;
  FilterPlugin::FilterArity arity() const override { return FilterPlugin::SINGLE_MESH; }
  int changes() const override;
  RichParameterList parameters(const MeshDocument& document) const override;
  Outcome apply(const RichParameterList& parameters, MeshDocument& document,
                const Context::Progress& progress) const override;

 private:
  bool changes_shape() const {
    return operation_.moves_points || operation_.adds_points || operation_.carries_values;
  }
  std::vector<Parameter> own_parameters() const;
  bool takes_landmarks() const;

  const Operation& operation_;
};

}  // namespace symsurf::meshlab
