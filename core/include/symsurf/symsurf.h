#pragma once

#include <symsurf/damage.h>
#include <symsurf/detect.h>
#include <symsurf/downsample.h>
#include <symsurf/errors.h>
#include <symsurf/make_mirror.h>
#include <symsurf/match.h>
#include <symsurf/method.h>
#include <symsurf/metrics.h>
#include <symsurf/normals.h>
#include <symsurf/plane.h>
#include <symsurf/read.h>
#include <symsurf/result.h>
#include <symsurf/sphere.h>
#include <symsurf/surface.h>
#include <symsurf/surface_mirror.h>
#include <symsurf/synthetic.h>
