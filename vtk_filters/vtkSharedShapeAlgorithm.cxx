#include "vtkSharedShapeAlgorithm.h"

#include "vtkMultiProcessController.h"

vtkCxxSetObjectMacro(vtkSharedShapeAlgorithm, Controller, vtkMultiProcessController);

vtkSharedShapeAlgorithm::vtkSharedShapeAlgorithm() {
  this->SetController(vtkMultiProcessController::GetGlobalController());
}

vtkSharedShapeAlgorithm::~vtkSharedShapeAlgorithm() { this->SetController(nullptr); }

void vtkSharedShapeAlgorithm::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
}
