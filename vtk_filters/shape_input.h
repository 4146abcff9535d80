#ifndef shape_input_h
#define shape_input_h

#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

class ControllerCommunicator;
class vtkInformationVector;
class vtkShapeAlgorithm;

/// The filter's shape, from its input 0 as vtkShapeAlgorithm describes; null where there is none.
/// Throws InvalidInput.
vtkSmartPointer<vtkPolyData> shape_of(vtkShapeAlgorithm* filter, vtkInformationVector** inputs);

/// The same of a shape that processes share out: where one cannot have its part all throw.
vtkSmartPointer<vtkPolyData> shape_of(vtkShapeAlgorithm* filter, vtkInformationVector** inputs,
                                      const ControllerCommunicator& processes);

#endif
