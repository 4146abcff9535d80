// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "filter.h"

/// The plugin as MeshLab loads it: hands each call on to the filter it is about.
class SymsurfPlugin : public QObject, public FilterPlugin {
  Q_OBJECT
  MESHLAB_PLUGIN_IID_EXPORTER(FILTER_PLUGIN_IID)
  Q_INTERFACES(FilterPlugin)

 public:
  SymsurfPlugin();

  QString pluginName() const override { return "FilterSymsurf"; }
  QString vendor() const override { return "symsurf"; }
  QString filterName(ActionIDType id) const override;
  QString pythonFilterName(ActionIDType id) const override;
  QString filterInfo(ActionIDType id) const override;
  FilterClass getClass(const QAction* action) const override;
  FilterArity filterArity(const QAction* action) const override;
  int postCondition(const QAction* action) const override;
  RichParameterList initParameterList(const QAction* action, const MeshDocument& document) override;

  /// Whatever goes wrong comes out as an MLException, the one kind MeshLab's window survives.
  std::map<std::string, QVariant> applyFilter(const QAction* action,
                                              const RichParameterList& parameters,
                                              MeshDocument& document,
                                              unsigned int& postConditionMask,
                                              vcg::CallBackPos* callback) override;

 private:
  const symsurf::meshlab::Filter& filter(ActionIDType id) const { return *filters_.at(id); }

  std::vector<std::unique_ptr<symsurf::meshlab::Filter>> filters_;
};
