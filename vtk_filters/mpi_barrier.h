#ifndef mpi_barrier_h
#define mpi_barrier_h

class vtkMultiProcessController;

// MPI's blocking calls poll while they wait. That is quickest where each process has a core of its
// own; where processes share cores, it slows down the very process that the others wait for. These
// calls poll ever more rarely; a blocking call right behind them hardly waits. Controllers other
// than MPI's do not poll: for them these calls do nothing.

/// Sends a signal to process `to`, and returns when that of `from` has come.
void signal_and_wait(vtkMultiProcessController* controller, int to, int from);

/// Returns when all processes have called it.
void barrier(vtkMultiProcessController* controller);

#endif
