#ifndef run_operation_h
#define run_operation_h

#include <symsurf/parameter.h>

#include <string>

class vtkInformationVector;
class vtkMirrorOperation;

/// What a filter is set to do: an operation of the core, by its names.
struct OperationCall {
  std::string operation;
  symsurf::Values parameters;
  std::string mask_array;  ///< the name of a point array; empty or "None": none
};

/// What the filter's RequestData has to do, and gives.
int run_operation(vtkMirrorOperation* filter, vtkInformationVector** inputs,
                  vtkInformationVector* outputs, const OperationCall& call);

#endif
