// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <common/ml_document/mesh_document.h>
#include <common/plugins/interfaces/filter_plugin.h>

#include <functional>
#include <map>
#include <string>

// A MeshLab without a window, to do to the plugin's filters what pymeshlab cannot.

/// Loads the plugin as MeshLab does, by its plugin manager.
FilterPlugin& load_plugin(const char* file);

/// Adds a layer whose plane of symmetry is x = 0.
void add_lump(MeshDocument& document, int size);

/// MeshLab's callback is a plain function: this one asks on_progress.
extern std::function<bool(int percent)> on_progress;
bool progress_callback(int percent, const char*);

/// One filter, run with its default parameters, or with one thread.
class Run {
 public:
  Run(FilterPlugin& plugin, QAction* action) : plugin_(plugin), action_(action) {}

  std::string name() const { return plugin_.pythonFilterName(action_).toStdString(); }

  void use_one_thread() { one_thread_ = true; }

  /// The message of the MLException, empty when there was none. Anything else ends the program, as
  /// it would end MeshLab.
  std::string operator()(MeshDocument& document, vcg::CallBackPos* progress = nullptr);

  /// What the last run returned and what it said it changed.
  const std::map<std::string, QVariant>& values() const { return values_; }
  unsigned int mask() const { return mask_; }

 private:
  FilterPlugin& plugin_;
  QAction* action_;
  std::map<std::string, QVariant> values_;
  unsigned int mask_ = 0;
  bool one_thread_ = false;
};
