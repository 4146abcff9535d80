#include "vtkMirrorOperation.h"

#include <symsurf/detect.h>

#include "vtkInformation.h"

vtkMirrorOperation::vtkMirrorOperation() : Method(symsurf::methods().front().name) {
  this->SetNumberOfInputPorts(4);
}

int vtkMirrorOperation::FillInputPortInformation(int port, vtkInformation* info) {
  if (port > 0) info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return this->Superclass::FillInputPortInformation(port, info);
}

void vtkMirrorOperation::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "RequireFound: " << (this->RequireFound ? "On" : "Off") << "\n";
  os << indent << "Kinds: " << this->Kinds << "\n";
}
