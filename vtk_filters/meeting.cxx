#include "meeting.h"

#include "vtkMultiProcessController.h"

#if VTK_MODULE_ENABLE_VTK_ParallelMPI

#include <algorithm>
#include <chrono>
#include <thread>

#include "vtkMPIController.h"

namespace {

constexpr int meeting_tag = 7121;

// Awake at first: where each process has a core of its own, many waits are shorter than falling
// asleep. Then each sleep is a small part of the time waited so far, and oversleeping costs no
// more.
void wait(vtkMPICommunicator::Request& request) {
  using std::chrono::steady_clock, std::chrono::microseconds;
  constexpr steady_clock::duration patience = microseconds(20), longest = microseconds(1000);
  constexpr int part = 16;
  const auto start = steady_clock::now();
  while (!request.Test()) {
    const auto waited = steady_clock::now() - start;
    if (waited > patience) std::this_thread::sleep_for(std::min(waited / part, longest));
  }
}

}  // namespace

void meet(vtkMultiProcessController* controller, int to, int from) {
  const auto mpi = vtkMPIController::SafeDownCast(controller);
  if (!mpi) return;
  const char here = 1;
  char there = 0;
  vtkMPICommunicator::Request heard;
  mpi->NoBlockReceive(&there, 1, from, meeting_tag, heard);
  mpi->Send(&here, 1, to, meeting_tag);
  wait(heard);
}

#else

void meet(vtkMultiProcessController*, int, int) {}

#endif

// The dissemination barrier of Hensgen, Finkel and Manber (1988).
void meet_all(vtkMultiProcessController* controller) {
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  for (int step = 1; step < size; step *= 2)
    meet(controller, (rank + step) % size, (rank + size - step) % size);
}
