// SPDX-License-Identifier: GPL-3.0-or-later
//
// Does to the plugin's filters what pymeshlab cannot: cancels them, throws out of the progress
// callback, hands them layers with deleted vertices and documents without layers. Prints the
// mirrors of one lump, a line a figure, and what fails; exit code 0: all as it should be.
//
//   host PLUGIN

#include <QApplication>
#include <iostream>
#include <sstream>

#include "plugin_host.h"

namespace {

using Allocator = vcg::tri::Allocator<CMeshO>;

int failures = 0;

void expect(bool holds, const std::string& what) {
  if (holds) return;
  ++failures;
  std::cout << "FAILED: " << what << "\n";
}

std::string state(const MeshDocument& document) {
  std::ostringstream text;
  text.precision(17);
  for (auto it = document.meshBegin(); it != document.meshEnd(); ++it) {
    text << it->label().toStdString() << it->dataMask() << " " << it->cm.vert_attr.size() << "\n";
    for (const CVertexO& v : it->cm.vert)
      text << v.IsD() << v.cQ() << int(v.cC()[0]) << v.cP()[0] << v.cP()[1] << v.cP()[2] << "\n";
  }
  return text.str();
}

void cancels_at_every_report(Run& run) {
  int reports = 1;
  for (int last = 0; last < reports; ++last) {
    MeshDocument document;
    add_lump(document, 300);
    const std::string before = state(document);
    int seen = 0;
    bool stopped = false;
    on_progress = [&](int percent) {
      expect(percent >= 0 && percent <= 100, run.name() + ": percent");
      expect(!stopped, run.name() + ": reports after it was told to stop");
      stopped = seen++ == last;
      return !stopped;
    };
    const std::string message = run(document, progress_callback);
    reports = std::min(seen + 1, 6);
    if (!stopped) return;
    expect(message.find("cancelled") != std::string::npos, run.name() + ": '" + message + "'");
    expect(state(document) == before, run.name() + ": cancelled, yet the document changed");
  }
}

void survives_a_throwing_callback(Run& run) {
  MeshDocument document;
  add_lump(document, 300);
  const std::string before = state(document);
  on_progress = [](int) -> bool { throw std::runtime_error("the host's own trouble"); };
  const std::string message = run(document, progress_callback);
  expect(message.find("the host's own trouble") != std::string::npos, run.name() + ": " + message);
  on_progress = [](int) -> bool { throw 42; };
  expect(!run(document, progress_callback).empty(), run.name() + ": a thrown number passed unseen");
  expect(state(document) == before, run.name() + ": failed, yet the document changed");
}

void refuses_what_is_not_there(Run& run) {
  MeshDocument document;
  expect(!run(document).empty(), run.name() + ": no layer, no error");
  expect(document.meshNumber() == 0, run.name() + ": a layer out of nothing");
  add_lump(document, 100);
  for (CVertexO& vertex : document.mm()->cm.vert)
    Allocator::DeleteVertex(document.mm()->cm, vertex);
  const std::string before = state(document);
  const std::string message = run(document);
  expect(message.find("no vertices") != std::string::npos, run.name() + ": " + message);
  expect(state(document) == before, run.name() + ": refused, yet the document changed");
}

// Deleted vertices count for nothing, and partners are numbered by vertex. Operations leave no
// deleted vertices behind, and their arrays have other names.
void skips_deleted_vertices(Run& run) {
  MeshDocument whole, holes;
  add_lump(whole, 250);
  add_lump(holes, 500);
  CMeshO& full = whole.mm()->cm;
  CMeshO& mesh = holes.mm()->cm;
  for (int i = 0; i < 500; ++i) {
    if (i % 2 == 0)
      mesh.vert[i].P() = full.vert[i / 2].P();
    else
      Allocator::DeleteVertex(mesh, mesh.vert[i]);
  }
  vcg::tri::UpdateBounding<CMeshO>::Box(mesh);
  expect(run(whole).empty() && run(holes).empty(), run.name() + ": does not run");
  const int step = mesh.vert.size() == 250 ? 1 : 2;
  const std::string name = run.name() == "compute_mirror_correspondences" ? "index" : "partner";
  auto partner = Allocator::FindPerVertexAttribute<Scalarm>(full, name);
  auto sparse = Allocator::FindPerVertexAttribute<Scalarm>(mesh, name);
  for (int i = 0; i < 250; ++i) {
    expect(full.vert[i].P() == mesh.vert[step * i].P(), run.name() + ": place");
    expect(full.vert[i].Q() == mesh.vert[step * i].Q(), run.name() + ": quality");
    if (Allocator::IsValidHandle(full, partner))
      expect(sparse[step * i] == (partner[i] < 0 ? -1 : step * partner[i]),
             run.name() + ": partner");
  }
}

void print_mirror(Run& run, unsigned int mask) {
  MeshDocument document;
  add_lump(document, 250);
  expect(run(document).empty(), run.name() + ": does not run");
  expect(run.mask() == mask, run.name() + ": says that it changed something else");
  for (const auto& [name, value] : run.values()) {
    std::cout << run.name() << " " << name;
    if (value.canConvert<Matrix44m>())
      for (int i = 0; i < 16; ++i) std::cout << " " << value.value<Matrix44m>()[i / 4][i % 4];
    else if (value.canConvert<Matrix33m>())
      for (int i = 0; i < 9; ++i) std::cout << " " << value.value<Matrix33m>()[i / 3][i % 3];
    else if (value.canConvert<Point3m>())
      for (int i = 0; i < 3; ++i) std::cout << " " << value.value<Point3m>()[i];
    else
      std::cout << " " << value.toDouble();
    std::cout << "\n";
  }
}

void offers_no_preview(FilterPlugin& plugin, QAction* action) {
  const int layers = MeshModel::MM_VERTNUMBER | MeshModel::MM_FACENUMBER;
  expect((plugin.postCondition(action) & layers) != 0, "a preview of a filter that adds layers");
  expect(plugin.getClass(action) != FilterPlugin::Generic, "a filter of no class");
  expect(action->parent() != nullptr, "an action without parent");
}

}  // namespace

int main(int argc, char** argv) {
  QCoreApplication application(argc, argv);
  FilterPlugin& plugin = load_plugin(argv[1]);
  int filters = 0;
  std::cout.precision(17);
  for (QAction* action : plugin.actions()) {
    offers_no_preview(plugin, action);
    Run run(plugin, action);
    const bool is_mirrored = run.name().find("_mirror_") != std::string::npos;
    // The last takes meshes alone.
    if (!is_mirrored || run.name() == "apply_mirror_reflection" ||
        run.name() == "create_mirror_sample" || run.name() == "apply_mirror_remeshing")
      continue;
    ++filters;
    cancels_at_every_report(run);
    survives_a_throwing_callback(run);
    refuses_what_is_not_there(run);
    if (run.name() != "apply_mirror_cut") skips_deleted_vertices(run);  // it gives other vertices
    print_mirror(run, static_cast<unsigned int>(plugin.postCondition(action)));
  }
  expect(filters > 0, "the plugin has filters");
  std::cout << filters << " filters, " << failures << " failures" << std::endl;
  std::_Exit(failures == 0 ? 0 : 1);
}
