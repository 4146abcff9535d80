// SPDX-License-Identifier: GPL-3.0-or-later
#include "filter_symsurf.h"

#include <symsurf/context.h>

#include "analysis_filter.h"
#include "detection_filter.h"
#include "operation_filter.h"
#include "reflection_filter.h"
#include "sample_filter.h"

using namespace symsurf;
using namespace symsurf::meshlab;

namespace {

std::vector<std::unique_ptr<Filter>> all_filters() {
  std::vector<std::unique_ptr<Filter>> filters;
  for (const Method& method : methods())
    filters.push_back(std::make_unique<DetectionFilter>(method));
  for (const Operation& operation : operations())
    filters.push_back(std::make_unique<OperationFilter>(operation));
  for (const Analysis& analysis : analyses())
    filters.push_back(std::make_unique<AnalysisFilter>(analysis));
  filters.push_back(std::make_unique<ReflectionFilter>());
  filters.push_back(std::make_unique<SampleFilter>());
  return filters;
}

[[noreturn]] void fail(const std::string& title, const std::string& why) {
  throw MLException(QString::fromStdString(title + ": " + why + "."));
}

}  // namespace

SymsurfPlugin::SymsurfPlugin() : filters_(all_filters()) {
  for (ActionIDType id = 0; id < static_cast<ActionIDType>(filters_.size()); ++id) {
    typeList.push_back(id);
    actionList.push_back(new QAction(filterName(id), this));
  }
}

QString SymsurfPlugin::filterName(ActionIDType id) const {
  return QString::fromStdString(filter(id).title());
}

QString SymsurfPlugin::pythonFilterName(ActionIDType id) const {
  return QString::fromStdString(filter(id).python_name());
}

QString SymsurfPlugin::filterInfo(ActionIDType id) const {
  return QString::fromStdString(filter(id).info());
}

FilterPlugin::FilterClass SymsurfPlugin::getClass(const QAction* action) const {
  return filter(ID(action)).menus();
}

FilterPlugin::FilterArity SymsurfPlugin::filterArity(const QAction* action) const {
  return filter(ID(action)).arity();
}

int SymsurfPlugin::postCondition(const QAction* action) const {
  return filter(ID(action)).changes();
}

RichParameterList SymsurfPlugin::initParameterList(const QAction* action,
                                                   const MeshDocument& document) {
  return filter(ID(action)).parameters(document);
}

std::map<std::string, QVariant> SymsurfPlugin::applyFilter(const QAction* action,
                                                           const RichParameterList& parameters,
                                                           MeshDocument& document,
                                                           unsigned int& postConditionMask,
                                                           vcg::CallBackPos* callback) {
  const Filter& chosen = filter(ID(action));
  const std::string title = chosen.title();
  const auto progress = [&](double fraction) {
    return !callback || callback(static_cast<int>(100 * fraction), title.c_str());
  };
  try {
    Outcome outcome = chosen.apply(parameters, document, progress);
    postConditionMask = static_cast<unsigned int>(chosen.changes());
    for (const std::string& line : outcome.log) log(title + ": " + line);
    return std::move(outcome.values);
  } catch (const MLException&) {
    throw;
  } catch (const Cancelled&) {
    fail(title, "cancelled; the document is as it was");
  } catch (const std::bad_alloc&) {
    fail(title, "there is not enough memory");
  } catch (const std::exception& error) {
    fail(title, error.what());
  } catch (...) {
    fail(title, "an unknown error");
  }
}
