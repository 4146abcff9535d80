#include "vtkSMColourRangesProxy.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>

#include "vtkCommand.h"
#include "vtkDataObject.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkPVXMLElement.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxyManager.h"
#include "vtkSMProxySelectionModel.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMTransferFunctionManager.h"
#include "vtkSMTransferFunctionProxy.h"

vtkStandardNewMacro(vtkSMColourRangesProxy);

namespace {

// Calls it with each hint of a name.
template <typename Call>
void for_each_hint(vtkPVXMLElement* hints, const std::string& name, const Call& call) {
  for (unsigned int i = 0; hints && i < hints->GetNumberOfNestedElements(); ++i)
    if (name == hints->GetNestedElement(i)->GetName()) call(hints->GetNestedElement(i));
}

bool has_values(vtkPVDataInformation* data, const char* cell_array, int least_different) {
  vtkPVArrayInformation* values = data->GetCellDataInformation()->GetArrayInformation(cell_array);
  if (!values) return false;
  const double* range = values->GetComponentRange(0);
  return least_different < 2 ? range[0] <= range[1] : range[0] < range[1];
}

vtkSMRenderViewProxy* active_view(vtkSMSessionProxyManager* proxies) {
  vtkSMProxySelectionModel* active = proxies->GetSelectionModel("ActiveView");
  return vtkSMRenderViewProxy::SafeDownCast(active ? active->GetCurrentProxy() : nullptr);
}

double largest_size(vtkPVArrayInformation* values) {
  const double* range = values->GetComponentFiniteRange(0);
  return std::max(std::abs(range[0]), std::abs(range[1]));
}

// 0: all values are 0, or there are none.
double limit_of(vtkPVDataInformation* data, const char* array, const char* limit) {
  constexpr double rounding = 1e-6;  // of the largest size
  vtkPVArrayInformation* values = data->GetPointDataInformation()->GetArrayInformation(array);
  if (!values) return 0;
  const double largest = largest_size(values);
  if (!std::isfinite(largest)) return 0;
  vtkPVArrayInformation* field = data->GetFieldDataInformation()->GetArrayInformation(limit);
  if (!field) return largest;
  const double percentile = largest_size(field);
  return percentile > rounding * largest ? std::min(percentile, largest) : largest;
}

// The legend that the active view will show for the colours; a title that somebody gave it stays.
void set_legend_title(vtkSMTransferFunctionManager* manager, vtkSMProxy* colours,
                      vtkSMSessionProxyManager* proxies, const std::string& summary,
                      const std::string& title) {
  vtkSMRenderViewProxy* view = active_view(proxies);
  vtkSMProxy* legend = view ? manager->GetScalarBarRepresentation(colours, view) : nullptr;
  if (!legend) return;
  const std::string given = vtkSMPropertyHelper(legend, "Title").GetAsString();
  const bool is_ours =
      given == title || (given.size() > title.size() + 1 &&
                         given.substr(given.size() - title.size() - 1) == "\n" + title);
  if (!is_ours && !legend->GetProperty("Title")->IsValueDefault()) return;
  vtkSMPropertyHelper(legend, "Title")
      .Set((summary.empty() ? title : summary + "\n" + title).c_str());
  if (is_ours) return legend->UpdateVTKObjects();
  vtkSMPropertyHelper(legend, "ComponentTitle").Set("");
  vtkSMPropertyHelper(legend, "Visibility").Set(0);
  vtkSMPropertyHelper(legend, "Enabled").Set(0);
  legend->UpdateVTKObjects();
}

}  // namespace

void vtkSMColourRangesProxy::PostUpdateData(bool using_cache) {
  this->Superclass::PostUpdateData(using_cache);
  for_each_hint(this->GetHints(), "ColourRange",
                [this](vtkPVXMLElement* hint) { this->SetColours(hint); });
  if (this->IsObserving) return;
  this->GetSessionProxyManager()->AddObserver(vtkCommand::RegisterEvent, this,
                                              &vtkSMColourRangesProxy::ShowAtFirst);
  this->IsObserving = true;
}

void vtkSMColourRangesProxy::ShowAtFirst(vtkObject*, unsigned long, void* registered) {
  const auto* made = static_cast<vtkSMProxyManager::RegisteredProxyInformation*>(registered);
  if (made->Type != vtkSMProxyManager::RegisteredProxyInformation::PROXY ||
      std::string(made->GroupName) != "representations" || !made->Proxy->GetProperty("Input") ||
      !made->Proxy->GetProperty("Opacity"))
    return;
  const vtkSMPropertyHelper input(made->Proxy, "Input");
  if (input.GetAsProxy() != this) return;
  for_each_hint(this->GetHints(), "Display", [&](vtkPVXMLElement* hint) {
    int port = 0;
    hint->GetScalarAttribute("port", &port);
    if (port == static_cast<int>(input.GetOutputPort())) this->SetDisplay(hint, made->Proxy);
  });
}

void vtkSMColourRangesProxy::SetDisplay(vtkPVXMLElement* hint, vtkSMProxy* representation) {
  double opacity = 1;
  int port = 0, least_different = 1;
  hint->GetScalarAttribute("opacity", &opacity);
  hint->GetScalarAttribute("port", &port);
  hint->GetScalarAttribute("least_different", &least_different);
  const char* array = hint->GetAttribute("array");
  const double blue[] = {0.15, 0.4, 0.8};
  vtkSMPropertyHelper(representation, "Opacity").Set(opacity);
  vtkSMPropertyHelper(representation, "AmbientColor", true).Set(blue, 3);
  vtkSMPropertyHelper(representation, "DiffuseColor", true).Set(blue, 3);
  representation->UpdateVTKObjects();
  if (!has_values(this->GetDataInformation(port), array, least_different)) return;
  vtkSMPVRepresentationProxy::SetScalarColoring(representation, array, vtkDataObject::CELL);
  vtkSMPVRepresentationProxy::RescaleTransferFunctionToDataRange(representation);
  vtkNew<vtkSMTransferFunctionManager> manager;
  vtkSMSessionProxyManager* proxies = this->GetSessionProxyManager();
  set_legend_title(manager, manager->GetColorTransferFunction(array, proxies), proxies,
                   this->Summary(), hint->GetAttribute("title"));
}

std::string vtkSMColourRangesProxy::Summary() {
  std::string text;
  for_each_hint(this->GetHints(), "Summary", [&](vtkPVXMLElement* hint) {
    std::istringstream names(hint->GetAttribute("fields"));
    vtkPVDataSetAttributesInformation* fields =
        this->GetDataInformation(0)->GetFieldDataInformation();
    for (std::string name; names >> name;) {
      vtkPVArrayInformation* field = fields->GetArrayInformation(name.c_str());
      if (!field) continue;
      if (!text.empty()) text += ", ";
      if (field->GetNumberOfStringValues() > 0) {
        text += field->GetStringValue(0);
      } else {
        std::ostringstream number;
        number << std::fixed << std::setprecision(2) << field->GetComponentRange(0)[0];
        std::transform(name.begin(), name.end(), name.begin(),
                       [](char c) { return std::tolower(c); });
        text += name + " " + number.str();
      }
    }
  });
  return text;
}

void vtkSMColourRangesProxy::SetColours(vtkPVXMLElement* hint) {
  const char* array = hint->GetAttribute("array");
  int port = 0, is_signed = 0;
  hint->GetScalarAttribute("port", &port);
  hint->GetScalarAttribute("signed", &is_signed);
  double limit = limit_of(this->GetDataInformation(port), array, hint->GetAttribute("limit"));
  vtkNew<vtkSMTransferFunctionManager> manager;
  vtkSMSessionProxyManager* proxies = this->GetSessionProxyManager();
  vtkSMProxy* colours = manager->GetColorTransferFunction(array, proxies);
  set_legend_title(manager, colours, proxies, this->Summary(), hint->GetAttribute("title"));
  if (limit == 0) return;

  vtkSMPropertyHelper rescaling(colours, "AutomaticRescaleRangeMode");
  if (vtkSMPropertyHelper(colours, "ScalarRangeInitialized").GetAsInt()) {
    const vtkSMPropertyHelper points(colours, "RGBPoints");  // a value and its colour each
    const double least = points.GetAsDouble(0);
    const double most = points.GetAsDouble(points.GetNumberOfElements() - 4);
    if (rescaling.GetAsInt() != vtkSMTransferFunctionManager::NEVER ||
        least != (is_signed ? -most : 0))
      return;
    limit = std::max(limit, most);
  } else {
    // White in the middle, whatever the user's settings colour other arrays by.
    if (is_signed) vtkSMTransferFunctionProxy::ApplyPreset(colours, "Cool to Warm", false);
    const double grey[] = {0.6, 0.6, 0.6};  // yellow, ParaView's own, cries out where nothing is
    vtkSMPropertyHelper(colours, "NanColor").Set(grey, 3);
  }
  rescaling.Set(vtkSMTransferFunctionManager::NEVER);
  colours->UpdateVTKObjects();
  vtkSMTransferFunctionProxy::RescaleTransferFunction(colours, is_signed ? -limit : 0, limit);
}
