#include "vtkMirrorOperation.h"

#include <symsurf/method.h>

#include "vtkInformation.h"
#include "vtkMultiProcessController.h"

vtkCxxSetObjectMacro(vtkMirrorOperation, Controller, vtkMultiProcessController);

vtkMirrorOperation::vtkMirrorOperation() : Method(symsurf::methods().front().name) {
  this->SetNumberOfInputPorts(2);
  this->SetController(vtkMultiProcessController::GetGlobalController());
}

vtkMirrorOperation::~vtkMirrorOperation() { this->SetController(nullptr); }

int vtkMirrorOperation::FillInputPortInformation(int port, vtkInformation* info) {
  if (port == 1) info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return this->Superclass::FillInputPortInformation(port, info);
}

void vtkMirrorOperation::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
}
