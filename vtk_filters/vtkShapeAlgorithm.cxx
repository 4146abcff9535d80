#include "vtkShapeAlgorithm.h"

#include "vtkInformation.h"

int vtkShapeAlgorithm::FillInputPortInformation(int port, vtkInformation* info) {
  if (port != 0) return this->Superclass::FillInputPortInformation(port, info);
  // Of anything else VTK would hand in the blocks of a composite one by one.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

void vtkShapeAlgorithm::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ImageThreshold: " << this->ImageThreshold << "\n";
}
