#ifndef shared_points_h
#define shared_points_h

#include <symsurf/context.h>

#include "point_arrays.h"

class vtkMultiProcessController;

/// The points of all processes, in the order of their ranks, and which of them are this one's.
/// With one process or no controller: the own points where they lie.
class SharedPoints {
 public:
  /// Collective: every process of the controller must come here. A process may have no points.
  SharedPoints(vtkMultiProcessController* controller, const PointArray& own);

  symsurf::PointsView all() const { return all_.view(); }
  symsurf::Rows own_rows() const { return own_; }

 private:
  PointArray all_;
  symsurf::Rows own_;
};

#endif
