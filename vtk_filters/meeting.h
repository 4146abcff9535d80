#ifndef meeting_h
#define meeting_h

class vtkMultiProcessController;

// MPI's blocking calls spin while they wait. That is quickest where each process has a core of its
// own; where processes share cores, it holds up the very process that all wait for. Who meets
// first, asleep until the others are there, has hardly anything left to wait for in the blocking
// call. Controllers other than MPI's wait without spinning: for them there is nothing to do.

/// Tells process `to` that this one is here, and returns when `from` has told the same.
void meet(vtkMultiProcessController* controller, int to, int from);

/// Returns when all processes are here.
void meet_all(vtkMultiProcessController* controller);

#endif
