#include "mpi_barrier.h"

#include "vtkMultiProcessController.h"

#if VTK_MODULE_ENABLE_VTK_ParallelMPI

#include <algorithm>
#include <chrono>
#include <thread>

#include "vtkMPIController.h"

namespace {

constexpr int signal_tag = 7121;

// Polls all the time at first: many waits are shorter than the shortest sleep. Then it sleeps
// between two polls for a small part of the time waited so far, which is the most that it can lose.
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

void signal_and_wait(vtkMultiProcessController* controller, int to, int from) {
  const auto mpi = vtkMPIController::SafeDownCast(controller);
  if (!mpi) return;
  const char here = 1;
  char there = 0;
  vtkMPICommunicator::Request received;
  mpi->NoBlockReceive(&there, 1, from, signal_tag, received);
  mpi->Send(&here, 1, to, signal_tag);
  wait(received);
}

#else

void signal_and_wait(vtkMultiProcessController*, int, int) {}

#endif

// The dissemination barrier of Hensgen, Finkel and Manber (1988).
void barrier(vtkMultiProcessController* controller) {
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  for (int step = 1; step < size; step *= 2)
    signal_and_wait(controller, (rank + step) % size, (rank + size - step) % size);
}
