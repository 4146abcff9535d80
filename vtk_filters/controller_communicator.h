#ifndef controller_communicator_h
#define controller_communicator_h

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <functional>
#include <string>

#include "vtkMultiProcessController.h"

/// The processes of a VTK controller as the core wants them.
class ControllerCommunicator : public symsurf::Communicator {
 public:
  explicit ControllerCommunicator(vtkMultiProcessController* controller)
      : controller_(controller) {}

  int rank() const override { return controller_ ? controller_->GetLocalProcessId() : 0; }
  int size() const override { return controller_ ? controller_->GetNumberOfProcesses() : 1; }
  std::vector<Bytes> all_gather(std::span<const std::byte> mine) const override;
  Bytes send_recv(int other, std::span<const std::byte> mine) const override;

 private:
  vtkMultiProcessController* controller_;
};

/// Runs what each process does for itself, in all of them: what one throws as InvalidInput all
/// throw, in the same words. One that threw alone would keep the others waiting.
void together(const ControllerCommunicator& processes, const std::function<void()>& part);

/// Whether another process has the points, all of them. Throws InvalidInput where several have
/// some, in all processes together: one that threw alone would keep the others waiting. `what`:
/// what needs them, as "an operation".
bool are_elsewhere(const ControllerCommunicator& processes, symsurf::Index own,
                   const std::string& what);

#endif
