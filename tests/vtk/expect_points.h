#pragma once

#include <gtest/gtest.h>
#include <symsurf/points.h>

#include "vtkPolyData.h"

/// Expects the data set's points to be these, bit for bit.
inline void expect_points(vtkPolyData* data, const symsurf::Points& expected) {
  ASSERT_EQ(data->GetNumberOfPoints(), expected.rows());
  for (symsurf::Index i = 0; i < expected.rows(); ++i)
    EXPECT_EQ(symsurf::Vector3(data->GetPoint(i)), expected.row(i).transpose()) << i;
}
