#pragma once

#include <symsurf/detect.h>
#include <symsurf/downsample.h>
#include <symsurf/errors.h>
#include <symsurf/make_mirror.h>
#include <symsurf/match.h>
#include <symsurf/method.h>
#include <symsurf/normals.h>
#include <symsurf/plane.h>
#include <symsurf/read.h>
#include <symsurf/result.h>
#include <symsurf/sphere.h>
