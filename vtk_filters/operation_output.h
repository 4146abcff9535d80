#ifndef operation_output_h
#define operation_output_h

#include <symsurf/attributes.h>

#include "carried_arrays.h"
#include "vtkNew.h"

class TriangleArray;
class vtkPolyData;

/// Makes the output the input with what an operation on its points and its triangles gave, and what
/// the transform makes of its arrays, some of which are of other kinds than the active ones. Gives
/// what was added: the output's points with the added cells alone, and their data.
vtkNew<vtkPolyData> set_operated(vtkPolyData* output, vtkPolyData* input,
                                 const TriangleArray& faces, const symsurf::OperationResult& result,
                                 const symsurf::AttributeTransform& by, const KindsByName& kinds);

/// Makes the patch what was added, with the points from `first_added` on and those that added cells
/// share with the input, and no others.
void set_patch(vtkPolyData* patch, vtkPolyData* added, symsurf::Index first_added);

#endif
