#include "vtkMirrorDetection.h"

#include <symsurf/context.h>
#include <symsurf/detect.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "chosen_parameters.h"
#include "controller_communicator.h"
#include "core_call.h"
#include "field_values.h"
#include "point_arrays.h"
#include "shape_input.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
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

// How many points the processes before this one have.
symsurf::Index points_before(const ControllerCommunicator& processes, symsurf::Index own) {
  if (processes.size() == 1) return 0;
  const auto counts = processes.all_gather(std::as_bytes(std::span(&own, 1)));
  symsurf::Index before = 0;
  for (int rank = 0; rank < processes.rank(); ++rank) {
    symsurf::Index count;
    std::memcpy(&count, counts[rank].data(), sizeof count);
    before += count;
  }
  return before;
}

void require_normals(const PointArray& normals, const PointArray& points) {
  if (normals.view().size() < points.view().size())
    throw symsurf::InvalidInput(
        "UseNormals is on, but the input has no point normals; compute them first, or do without");
}

void append(symsurf::Mesh& all, const symsurf::Mesh& mesh) {
  const symsurf::Index vertices = all.vertices.rows(), triangles = all.triangles.rows();
  all.vertices.conservativeResize(vertices + mesh.vertices.rows(), 3);
  all.vertices.bottomRows(mesh.vertices.rows()) = mesh.vertices;
  all.triangles.conservativeResize(triangles + mesh.triangles.rows(), 3);
  all.triangles.bottomRows(mesh.triangles.rows()) = mesh.triangles.array() + vertices;
}

// Each triangle with the rank and the score of its mirror.
void set_mirror_meshes(vtkPolyData* output, const symsurf::Result& result, bool with_candidates) {
  vtkNew<vtkIntArray> ranks;
  vtkNew<vtkDoubleArray> scores;
  ranks->SetName("Rank");
  scores->SetName("Score");
  symsurf::Mesh all;
  const auto add = [&](const symsurf::Result& found, int rank) {
    if (!found.mirror) return;
    const symsurf::Mesh mesh = found.mirror->mesh();
    append(all, mesh);
    for (symsurf::Index i = 0; i < mesh.triangles.rows(); ++i) {
      ranks->InsertNextValue(rank);
      scores->InsertNextValue(found.score);
    }
  };
  int rank = 0;
  add(result, rank);
  if (with_candidates)
    for (const symsurf::Result& candidate : result.candidates) add(candidate, ++rank);
  if (all.triangles.rows() == 0) return;
  set_triangles(output, all);
  output->GetCellData()->AddArray(ranks);
  output->GetCellData()->AddArray(scores);
}

void set_mirror_fields(vtkPolyData* output, const symsurf::Result& result) {
  vtkFieldData* field = output->GetFieldData();
  add_field_values(field, result.statistics);
  add_field_values(field, {{"method", result.method}, {"score", result.score}});
  add_field_values(field, symsurf::candidate_values(result));
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

// 1 where the mirror's signed distance is positive, -1 where it is negative, 0 on the mirror, where
// there is none and of points that are not finite.
vtkNew<vtkSignedCharArray> sides_of(symsurf::PointsView points, const symsurf::Result& result,
                                    const symsurf::Context& context) {
  auto sides = filled<vtkSignedCharArray>("MirrorSide", points.size(), 0);
  if (!result.mirror) return sides;
  const Eigen::VectorXd distances = result.mirror->signed_distance(points, context);
  for (symsurf::Index i = 0; i < points.size(); ++i)
    if (points[i].allFinite())
      sides->SetValue(i, static_cast<signed char>((distances[i] > 0) - (distances[i] < 0)));
  return sides;
}

// The least residual that at most a hundredth of all exceeds: where a colour map may end. NaN of
// none.
double p99(const Eigen::VectorXd& residuals) {
  if (residuals.size() == 0) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sizes(residuals.begin(), residuals.end());
  const auto place =
      static_cast<std::ptrdiff_t>(std::ceil(0.99 * static_cast<double>(sizes.size() - 1)));
  std::nth_element(sizes.begin(), sizes.begin() + place, sizes.end());
  return sizes[place];
}

void set_shape(vtkPolyData* output, symsurf::Index points_before, vtkSignedCharArray* sides,
               const symsurf::Result& result) {
  const vtkIdType count = sides->GetNumberOfValues();
  const auto partners = filled<vtkIdTypeArray>("MirrorPartner", count, -1);
  const auto residuals =
      filled<vtkDoubleArray>("MirrorResidual", count, std::numeric_limits<double>::quiet_NaN());
  vtkIdType* partner = partners->GetPointer(0);
  double* residual = residuals->GetPointer(0);
  for (symsurf::Index row = 0; row < result.pairs.rows(); ++row) {
    const vtkIdType i = result.pairs(row, 0) - points_before;
    partner[i] = result.pairs(row, 1);
    residual[i] = result.residuals[row];
  }
  vtkFieldData* field = output->GetFieldData();
  add_field_values(field, {{"mirror_residual_p99", p99(result.residuals)},
                           {"kind", std::string(result.mirror ? result.mirror->kind() : "none")},
                           {"score", result.score},
                           {"verdict", result.verdict()}});
  vtkPointData* data = output->GetPointData();
  data->AddArray(partners);
  data->AddArray(sides);
  data->SetScalars(residuals);
}

}  // namespace

vtkMirrorDetection::vtkMirrorDetection() { this->SetNumberOfOutputPorts(3); }

int vtkMirrorDetection::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                    vtkInformationVector* outputs) {
  return core_call(this, [&] {
    const ControllerCommunicator processes(this->Controller);
    const auto input = shape_of(this, inputs, processes);
    const PointArray points = points_of(input);
    const PointArray normals(this->UseNormals ? input->GetPointData()->GetNormals() : nullptr);
    if (this->UseNormals) together(processes, [&] { require_normals(normals, points); });
    const symsurf::Index before = points_before(processes, points.view().size());

    // Several processes use their points only: polygons that one cannot use would stop it alone.
    const TriangleArray faces(this->UseFaces && processes.size() == 1 ? input : nullptr);

    symsurf::Options options;
    options.method = this->Method;
    options.parameters = chosen_parameters(this);
    options.normals = normals.view();
    options.faces = faces.view();
    options.refuse_nonfinite = this->RefuseNonfinite;
    options.seed = this->Seed;
    const symsurf::Context context = context_of(this, this->NumberOfThreads);
    const symsurf::Result result =
        symsurf::detect(points.view(), options, context.stage(0, 0.95).sharing(&processes));
    if (processes.rank() == 0) warn_of(this, result.statistics);
    const auto sides = sides_of(points.view(), result, context.stage(0.95, 1));

    vtkPolyData* mirror = vtkPolyData::GetData(outputs, MIRROR);
    if (processes.rank() == 0) set_mirror_meshes(mirror, result, this->ShowCandidates);
    set_mirror_fields(mirror, result);
    set_surface_points(vtkPolyData::GetData(outputs, SURFACE_POINTS), result);
    vtkPolyData* shape = vtkPolyData::GetData(outputs, SHAPE);
    shape->ShallowCopy(input);
    set_shape(shape, before, sides, result);
  });
}

void vtkMirrorDetection::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "UseNormals: " << (this->UseNormals ? "On" : "Off") << "\n";
  os << indent << "UseFaces: " << (this->UseFaces ? "On" : "Off") << "\n";
  os << indent << "RefuseNonfinite: " << (this->RefuseNonfinite ? "On" : "Off") << "\n";
  os << indent << "ShowCandidates: " << (this->ShowCandidates ? "On" : "Off") << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
}
