// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <symsurf/context.h>

#include <map>
#include <string>
#include <vector>

#include "meshlab_host.h"

namespace symsurf::meshlab {

/// What a filter hands back to MeshLab once the document holds its results.
struct Outcome {
  std::map<std::string, QVariant> values;  ///< returned to pymeshlab and scripts, by name
  std::vector<std::string> log;            ///< lines for the log
};

/// One entry of MeshLab's menu.
class Filter {
 public:
  virtual ~Filter() = default;

  virtual std::string title() const = 0;        ///< in the menu; no two alike
  virtual std::string python_name() const = 0;  ///< in pymeshlab and in scripts
  virtual std::string info() const = 0;         ///< HTML for the head of the dialog
  virtual FilterPlugin::FilterClass menus() const = 0;
  virtual FilterPlugin::FilterArity arity() const = 0;

  /// What apply() changes, as MeshModel::MM_... bits.
  virtual int changes() const = 0;

  /// The dialog. The document may be without layers.
  virtual RichParameterList parameters(const MeshDocument& document) const = 0;

  /// Computes first and touches the document last, so that a failure leaves it as it was.
  /// Throws what the core throws.
  virtual Outcome apply(const RichParameterList& parameters, MeshDocument& document,
                        const Context::Progress& progress) const = 0;
};

}  // namespace symsurf::meshlab
