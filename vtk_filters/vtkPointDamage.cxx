#include "vtkPointDamage.h"

#include <symsurf/damage.h>

#include "chosen_parameters.h"
#include "core_call.h"
#include "point_arrays.h"
#include "point_subset.h"
#include "vtkCellData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

vtkStandardNewMacro(vtkPointDamage);

int vtkPointDamage::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                vtkInformationVector* outputs) {
  vtkPolyData* input = vtkPolyData::GetData(inputs[0]);
  vtkPolyData* output = vtkPolyData::GetData(outputs);
  return core_call(this, [&] {
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
