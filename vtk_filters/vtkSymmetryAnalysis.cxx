#include "vtkSymmetryAnalysis.h"

#include <symsurf/analyses.h>
#include <symsurf/context.h>

#include <string>
#include <variant>

#include "chosen_parameters.h"
#include "controller_communicator.h"
#include "core_call.h"
#include "described_arrays.h"
#include "field_values.h"
#include "operation_names.h"
#include "point_arrays.h"
#include "shape_input.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"

vtkStandardNewMacro(vtkSymmetryAnalysis);

namespace {

template <typename Array>
vtkNew<Array> named(const char* name, int components = 1) {
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  return array;
}

// The data of the cells: lines come before polygons.
class Elements {
 public:
  Elements() { points_->SetDataTypeToDouble(); }

  void add_axis(const symsurf::SymmetryAxis& axis, symsurf::PointsView shape, vtkIdType index) {
    lines_->InsertNextCell(2);
    for (const symsurf::Vector3& end : axis.segment(shape))
      lines_->InsertCellPoint(points_->InsertNextPoint(end.data()));
    add_data("axis", index, axis.order);
  }

  void add_plane(const symsurf::Plane& plane, vtkIdType index) {
    const symsurf::Mesh mesh = plane.mesh(1);
    const vtkIdType first = points_->GetNumberOfPoints();
    for (symsurf::Index v = 0; v < mesh.vertices.rows(); ++v)
      points_->InsertNextPoint(mesh.vertices.row(v).data());
    for (symsurf::Index t = 0; t < mesh.triangles.rows(); ++t) {
      polygons_->InsertNextCell(3);
      for (int corner = 0; corner < 3; ++corner)
        polygons_->InsertCellPoint(first + mesh.triangles(t, corner));
      add_data("plane", index, 2);
    }
  }

  void set(vtkPolyData* output) const {
    output->SetPoints(points_);
    output->SetLines(lines_);
    output->SetPolys(polygons_);
    output->GetCellData()->AddArray(kinds_);
    output->GetCellData()->AddArray(indices_);
    output->GetCellData()->AddArray(orders_);
  }

 private:
  void add_data(const char* kind, vtkIdType index, vtkIdType order) {
    kinds_->InsertNextValue(kind);
    indices_->InsertNextValue(index);
    orders_->InsertNextValue(order);
  }

  vtkNew<vtkPoints> points_;
  vtkNew<vtkCellArray> lines_, polygons_;
  vtkNew<vtkStringArray> kinds_ = named<vtkStringArray>("ElementKind");
  vtkNew<vtkIdTypeArray> indices_ = named<vtkIdTypeArray>("ElementIndex"),
                         orders_ = named<vtkIdTypeArray>("ElementOrder");
};

void set_elements(vtkPolyData* output, const symsurf::AnalysisResult& result) {
  Elements elements;
  vtkIdType index = 0;
  for (const symsurf::SymmetryAxis& axis : result.axes)
    elements.add_axis(axis, *result.footprint, index++);
  index = 0;
  for (const symsurf::Plane& plane : result.planes) elements.add_plane(plane, index++);
  elements.set(output);
}

// A row a point, a column a component.
Eigen::MatrixXd colours_of(vtkPolyData* shape, const std::string& name) {
  vtkPointData* data = shape->GetPointData();
  vtkDataArray* array = data->GetArray(name.c_str());
  const bool is_active = name.empty() || (name == "None" && !array);
  if (is_active) array = data->GetScalars();
  if (!array)
    throw symsurf::InvalidParameter(
        is_active ? "ColourArray is empty, and no scalars are active; texture needs colours"
                  : "ColourArray is '" + name + "', which the input has no point array of");
  Eigen::MatrixXd colours(array->GetNumberOfTuples(), array->GetNumberOfComponents());
  for (symsurf::Index row = 0; row < colours.rows(); ++row)
    for (int column = 0; column < colours.cols(); ++column)
      colours(row, column) = array->GetComponent(row, column);
  return colours;
}

bool is_on(const symsurf::Values& values, const char* name) {
  const auto found = values.find(name);
  return found != values.end() && std::get<bool>(found->second);
}

void set_transformations(vtkPolyData* output, symsurf::PointsView shape,
                         const symsurf::AnalysisResult& result) {
  const auto count = static_cast<symsurf::Index>(result.transformations.size());
  const auto kinds = named<vtkStringArray>("Kind");
  const auto scores = named<vtkDoubleArray>("Score");
  const auto matrices = named<vtkDoubleArray>("Matrix", 16);
  const auto from = named<vtkIdTypeArray>("FromPoints"), onto = named<vtkIdTypeArray>("OntoPoints");
  symsurf::Points places(count, 3);
  for (symsurf::Index i = 0; i < count; ++i) {
    const symsurf::Transformation& each = result.transformations[i];
    places.row(i) = each.place(shape).transpose();
    kinds->InsertNextValue(each.kind);
    scores->InsertNextValue(each.score);
    const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> rows = each.matrix;
    matrices->InsertNextTuple(rows.data());
    from->InsertNextValue(static_cast<vtkIdType>(each.from.size()));
    onto->InsertNextValue(static_cast<vtkIdType>(each.onto.size()));
  }
  set_vertices(output, places);
  for (vtkAbstractArray* array :
       std::initializer_list<vtkAbstractArray*>{kinds, scores, matrices, from, onto})
    output->GetPointData()->AddArray(array);
}

}  // namespace

vtkSymmetryAnalysis::vtkSymmetryAnalysis() {
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(3);
}

int vtkSymmetryAnalysis::FillInputPortInformation(int port, vtkInformation* info) {
  if (port == 1) info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return this->Superclass::FillInputPortInformation(port, info);
}

int vtkSymmetryAnalysis::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                     vtkInformationVector* outputs) {
  return core_call(this, [&] {
    const ControllerCommunicator processes(this->Controller);
    const auto input = shape_of(this, inputs, processes);
    const PointArray points = points_of(input);
    if (are_elsewhere(processes, points.view().size(), "an analysis")) return;
    const TriangleArray faces(this->UseFaces ? input : nullptr);
    symsurf::AnalysisOptions options;
    options.parameters = chosen_parameters(this);
    options.faces = faces.view();
    vtkPolyData* const second = vtkPolyData::GetData(inputs[1]);
    const PointArray other = points_of(second);
    const TriangleArray other_faces(this->UseFaces ? second : nullptr);
    options.other = other.view();
    options.other_faces = other_faces.view();
    options.refuse_nonfinite = this->RefuseNonfinite;
    if (is_on(options.parameters, "texture"))
      options.colours = colours_of(input, this->ColourArray);
    const symsurf::AnalysisResult result = symsurf::analyse(
        this->Analysis, points.view(), options, context_of(this, this->NumberOfThreads));
    warn_of(this, result.statistics);

    const symsurf::Analysis& described = symsurf::analysis(result.analysis);
    vtkPolyData* shape = vtkPolyData::GetData(outputs, SHAPE);
    shape->ShallowCopy(input);
    add_point_arrays(shape, joined_title(described.title), described.arrays, result.arrays,
                     described.shown);
    add_field_values(shape->GetFieldData(), result.statistics);
    add_field_values(shape->GetFieldData(), {{"analysis", result.analysis}});
    set_elements(vtkPolyData::GetData(outputs, ELEMENTS), result);
    set_transformations(vtkPolyData::GetData(outputs, TRANSFORMATIONS), points.view(), result);
  });
}

void vtkSymmetryAnalysis::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "UseFaces: " << (this->UseFaces ? "On" : "Off") << "\n";
  os << indent << "ColourArray: " << this->ColourArray << "\n";
  os << indent << "RefuseNonfinite: " << (this->RefuseNonfinite ? "On" : "Off") << "\n";
}
