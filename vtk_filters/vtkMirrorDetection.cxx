#include "vtkMirrorDetection.h"

#include <symsurf/detect.h>

#include <algorithm>
#include <limits>

#include "chosen_parameters.h"
#include "core_call.h"
#include "field_values.h"
#include "point_arrays.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSignedCharArray.h"

vtkStandardNewMacro(vtkMirrorDetection);

namespace {

template <typename Array, typename Value>
vtkNew<Array> filled(const char* name, vtkIdType size, Value value) {
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfValues(size);
  std::fill_n(array->GetPointer(0), size, value);
  return array;
}

void set_mirror(vtkPolyData* output, const symsurf::Result& result) {
  if (result.mirror) set_triangles(output, result.mirror->mesh());
  vtkFieldData* field = output->GetFieldData();
  add_field_values(field, result.statistics);
  add_field_values(field, {{"method", result.method}, {"score", result.score}});
  if (!result.mirror) return;
  add_field_values(field, {{"kind", std::string(result.mirror->kind())}});
  add_field_values(field, result.mirror->numbers());
}

void set_surface_points(vtkPolyData* output, const symsurf::Result& result) {
  set_vertices(output, result.surface_points);
  const auto residuals = filled<vtkDoubleArray>("Residual", result.residuals.size(), 0.0);
  std::copy_n(result.residuals.data(), result.residuals.size(), residuals->GetPointer(0));
  output->GetPointData()->SetScalars(residuals);
}

void set_mapping(vtkPolyData* output, const symsurf::PointsView& points,
                 const symsurf::Result& result) {
  const auto partners = filled<vtkIdTypeArray>("MirrorPartner", points.size(), -1);
  const auto residuals = filled<vtkDoubleArray>("MirrorResidual", points.size(),
                                                std::numeric_limits<double>::quiet_NaN());
  const auto sides = filled<vtkSignedCharArray>("MirrorSide", points.size(), 0);
  for (symsurf::Index row = 0; row < result.pairs.rows(); ++row) {
    partners->SetValue(result.pairs(row, 0), result.pairs(row, 1));
    residuals->SetValue(result.pairs(row, 0), result.residuals[row]);
  }
  if (result.mirror)
    for (symsurf::Index i = 0; i < points.size(); ++i) {
      const double distance = result.mirror->signed_distance(points[i]);
      sides->SetValue(i, static_cast<signed char>((distance > 0) - (distance < 0)));
    }
  vtkPointData* data = output->GetPointData();
  data->AddArray(partners);
  data->AddArray(sides);
  data->SetScalars(residuals);
}

}  // namespace

vtkMirrorDetection::vtkMirrorDetection() { this->SetNumberOfOutputPorts(3); }

int vtkMirrorDetection::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                    vtkInformationVector* outputs) {
  vtkPolyData* input = vtkPolyData::GetData(inputs[0]);
  return core_call(this, [&] {
    const PointArray points = points_of(input);
    const PointArray normals(this->UseNormals ? input->GetPointData()->GetNormals() : nullptr);

    symsurf::Options options;
    options.method = this->Method;
    options.parameters = chosen_parameters(this);
    options.normals = normals.view();
    options.seed = this->Seed;
    const symsurf::Result result =
        symsurf::detect(points.view(), options, context_of(this, this->NumberOfThreads));

    set_mirror(vtkPolyData::GetData(outputs, MIRROR), result);
    set_surface_points(vtkPolyData::GetData(outputs, SURFACE_POINTS), result);
    vtkPolyData* mapping = vtkPolyData::GetData(outputs, MAPPING);
    mapping->ShallowCopy(input);
    set_mapping(mapping, points.view(), result);
  });
}

void vtkMirrorDetection::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "UseNormals: " << (this->UseNormals ? "On" : "Off") << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
}
