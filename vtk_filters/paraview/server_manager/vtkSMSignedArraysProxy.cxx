#include "vtkSMSignedArraysProxy.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkPVXMLElement.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMTransferFunctionManager.h"
#include "vtkSMTransferFunctionProxy.h"

vtkStandardNewMacro(vtkSMSignedArraysProxy);

void vtkSMSignedArraysProxy::PostUpdateData(bool using_cache) {
  this->Superclass::PostUpdateData(using_cache);
  vtkPVXMLElement* hints = this->GetHints();
  for (unsigned int i = 0; hints && i < hints->GetNumberOfNestedElements(); ++i) {
    vtkPVXMLElement* hint = hints->GetNestedElement(i);
    if (std::string(hint->GetName()) == "SignedArray")
      this->CentreColours(hint->GetAttribute("name"));
  }
}

void vtkSMSignedArraysProxy::CentreColours(const char* array) {
  vtkPVArrayInformation* information =
      this->GetDataInformation(0)->GetPointDataInformation()->GetArrayInformation(array);
  if (!information) return;
  const double* range = information->GetComponentFiniteRange(0);
  double largest = std::max(std::abs(range[0]), std::abs(range[1]));
  if (!std::isfinite(largest) || largest == 0) return;

  vtkNew<vtkSMTransferFunctionManager> manager;
  vtkSMProxy* colours = manager->GetColorTransferFunction(array, this->GetSessionProxyManager());
  vtkSMPropertyHelper rescaling(colours, "AutomaticRescaleRangeMode");
  if (vtkSMPropertyHelper(colours, "ScalarRangeInitialized").GetAsInt()) {
    const vtkSMPropertyHelper points(colours, "RGBPoints");  // a value and its colour each
    const double least = points.GetAsDouble(0);
    const double most = points.GetAsDouble(points.GetNumberOfElements() - 4);
    if (rescaling.GetAsInt() != vtkSMTransferFunctionManager::NEVER || least != -most) return;
    largest = std::max(largest, most);
  } else {
    const double grey[] = {0.6, 0.6, 0.6};  // yellow, ParaView's own, cries out where nothing is
    vtkSMPropertyHelper(colours, "NanColor").Set(grey, 3);
  }
  rescaling.Set(vtkSMTransferFunctionManager::NEVER);
  colours->UpdateVTKObjects();
  vtkSMTransferFunctionProxy::RescaleTransferFunction(colours, -largest, largest);
}
