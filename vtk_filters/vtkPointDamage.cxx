#include "vtkPointDamage.h"

#include <symsurf/synthetic.h>

#include "chosen_parameters.h"
#include "core_call.h"
#include "point_arrays.h"
#include "point_subset.h"
#include "shape_input.h"
#include "vtkCellData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

vtkStandardNewMacro(vtkPointDamage);

int vtkPointDamage::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                vtkInformationVector* outputs) {
  vtkPolyData* output = vtkPolyData::GetData(outputs);
  return core_call(this, [&] {
    const auto input = shape_of(this, inputs);
    const symsurf::Damaged damaged =
        symsurf::damage(this->Damage, points_of(input).view(), chosen_parameters(this), this->Seed);
    set_subset(output, input, damaged.points, damaged.kept);
    output->GetPointData()->SetNormals(nullptr);
    output->GetCellData()->SetNormals(nullptr);
  });
}

void vtkPointDamage::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Seed: " << this->Seed << "\n";
}
