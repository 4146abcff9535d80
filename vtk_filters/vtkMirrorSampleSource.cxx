#include "vtkMirrorSampleSource.h"

#include <symsurf/synthetic.h>

#include "chosen_parameters.h"
#include "core_call.h"
#include "field_values.h"
#include "point_arrays.h"
#include "shape_input.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

vtkStandardNewMacro(vtkMirrorSampleSource);

namespace {

void set_sample(vtkPolyData* output, const symsurf::Sample& sample) {
  set_vertices(output, sample.points);
  vtkNew<vtkIdTypeArray> partners;
  partners->SetName("MirrorPartner");
  partners->SetNumberOfValues(sample.points.rows());
  partners->FillValue(-1);
  for (symsurf::Index row = 0; row < sample.pairs.rows(); ++row) {
    partners->SetValue(sample.pairs(row, 0), sample.pairs(row, 1));
    partners->SetValue(sample.pairs(row, 1), sample.pairs(row, 0));
  }
  output->GetPointData()->AddArray(partners);
}

}  // namespace

vtkMirrorSampleSource::vtkMirrorSampleSource() { this->SetNumberOfOutputPorts(2); }

int vtkMirrorSampleSource::FillInputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return this->Superclass::FillInputPortInformation(port, info);
}

int vtkMirrorSampleSource::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                       vtkInformationVector* outputs) {
  return core_call(this, [&] {
    const auto input = shape_of(this, inputs);
    const PointArray given = input ? points_of(input) : PointArray(nullptr);
    const symsurf::Sample sample =
        symsurf::generate(this->Generator, chosen_parameters(this), given.view());
    set_sample(vtkPolyData::GetData(outputs, SAMPLE), sample);
    vtkPolyData* mirror = vtkPolyData::GetData(outputs, MIRROR);
    set_triangles(mirror, sample.truth->mesh(sample.points));
    add_field_values(mirror->GetFieldData(), {{"kind", std::string(sample.truth->kind())}});
    add_field_values(mirror->GetFieldData(), sample.truth->numbers());
  });
}
