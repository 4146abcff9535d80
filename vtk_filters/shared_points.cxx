#include "shared_points.h"

#include <numeric>
#include <vector>

#include "vtkMultiProcessController.h"
#include "vtkNew.h"

SharedPoints::SharedPoints(vtkMultiProcessController* controller, const PointArray& own)
    : all_(own), own_{0, own.view().size()} {
  const int processes = controller ? controller->GetNumberOfProcesses() : 1;
  if (processes == 1) return;

  const vtkIdType count = own.view().size();
  std::vector<vtkIdType> counts(processes);
  controller->AllGather(&count, counts.data(), 1);
  std::vector<vtkIdType> lengths(processes), offsets(processes);
  for (int rank = 0; rank < processes; ++rank) lengths[rank] = 3 * counts[rank];
  std::exclusive_scan(lengths.begin(), lengths.end(), offsets.begin(), vtkIdType{0});

  vtkNew<vtkDoubleArray> gathered;
  gathered->SetNumberOfComponents(3);
  gathered->SetNumberOfTuples((offsets.back() + lengths.back()) / 3);
  controller->AllGatherV(own.view().data(), gathered->GetPointer(0), 3 * count, lengths.data(),
                         offsets.data());
  all_ = PointArray(gathered);
  own_.begin = offsets[controller->GetLocalProcessId()] / 3;
  own_.end = own_.begin + count;
}
