// SPDX-License-Identifier: GPL-3.0-or-later
#include "plugin_host.h"

#include <common/globals.h>
#include <common/plugins/plugin_manager.h>

#include <random>

std::function<bool(int percent)> on_progress;
bool progress_callback(const int percent, const char*) { return on_progress(percent); }

FilterPlugin& load_plugin(const char* file) {
  PluginManager& manager = meshlab::pluginManagerInstance();
  manager.loadPlugin(file);
  FilterPlugin* plugin = nullptr;
  for (FilterPlugin* candidate : manager.filterPluginIterator()) plugin = candidate;
  return *plugin;
}

void add_lump(MeshDocument& document, int size) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  CMeshO& mesh = document.addNewMesh("", "lump")->cm;
  auto vertex = vcg::tri::Allocator<CMeshO>::AddVertices(mesh, size);
  for (int i = 0; i < size / 2; ++i) {
    const double x = normal(random), y = 2 * normal(random), z = 3 * normal(random) + y * y / 3;
    (vertex++)->P() = Point3m(x, y, z);
    (vertex++)->P() = Point3m(-x, y, z);
  }
  vcg::tri::UpdateBounding<CMeshO>::Box(mesh);
}

std::string Run::operator()(MeshDocument& document, vcg::CallBackPos* progress) {
  mask_ = 0;
  RichParameterList parameters = plugin_.initParameterList(action_, document);
  if (one_thread_) parameters.setValue("threads", IntValue(1));
  try {
    values_ = plugin_.applyFilter(action_, parameters, document, mask_, progress);
  } catch (const MLException& error) {
    return error.what();
  }
  return "";
}
