#include "vtkSMColourRangesProxy.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkPVXMLElement.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxySelectionModel.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMTransferFunctionManager.h"
#include "vtkSMTransferFunctionProxy.h"

vtkStandardNewMacro(vtkSMColourRangesProxy);

namespace {

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
                      vtkSMSessionProxyManager* proxies, const char* title) {
  vtkSMProxySelectionModel* active = proxies->GetSelectionModel("ActiveView");
  auto* view = vtkSMRenderViewProxy::SafeDownCast(active ? active->GetCurrentProxy() : nullptr);
  vtkSMProxy* legend = view ? manager->GetScalarBarRepresentation(colours, view) : nullptr;
  if (!legend || !legend->GetProperty("Title")->IsValueDefault()) return;
  vtkSMPropertyHelper(legend, "Title").Set(title);
  vtkSMPropertyHelper(legend, "ComponentTitle").Set("");
  vtkSMPropertyHelper(legend, "Visibility").Set(0);
  vtkSMPropertyHelper(legend, "Enabled").Set(0);
  legend->UpdateVTKObjects();
}

}  // namespace

void vtkSMColourRangesProxy::PostUpdateData(bool using_cache) {
  this->Superclass::PostUpdateData(using_cache);
  vtkPVXMLElement* hints = this->GetHints();
  for (unsigned int i = 0; hints && i < hints->GetNumberOfNestedElements(); ++i)
    if (std::string(hints->GetNestedElement(i)->GetName()) == "ColourRange")
      this->SetColours(hints->GetNestedElement(i));
}

void vtkSMColourRangesProxy::SetColours(vtkPVXMLElement* hint) {
  const char* array = hint->GetAttribute("array");
  int port = 0, is_signed = 0;
  hint->GetScalarAttribute("port", &port);
  hint->GetScalarAttribute("signed", &is_signed);
  double limit = limit_of(this->GetDataInformation(port), array, hint->GetAttribute("limit"));
  if (limit == 0) return;

  vtkNew<vtkSMTransferFunctionManager> manager;
  vtkSMSessionProxyManager* proxies = this->GetSessionProxyManager();
  vtkSMProxy* colours = manager->GetColorTransferFunction(array, proxies);
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
    set_legend_title(manager, colours, proxies, hint->GetAttribute("title"));
  }
  rescaling.Set(vtkSMTransferFunctionManager::NEVER);
  colours->UpdateVTKObjects();
  vtkSMTransferFunctionProxy::RescaleTransferFunction(colours, is_signed ? -limit : 0, limit);
}
