#pragma once

#include <symsurf/analyses.h>
#include <symsurf/attributes.h>
#include <symsurf/context.h>
#include <symsurf/detect.h>
#include <symsurf/io.h>
#include <symsurf/mirrors.h>
#include <symsurf/operations.h>
#include <symsurf/placement.h>
#include <symsurf/point_summary.h>
#include <symsurf/points.h>
#include <symsurf/synthetic.h>
