// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <symsurf/detect.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "meshlab_host.h"

namespace symsurf::meshlab {

/// A figure in a type that MeshLab passes on to pymeshlab; none for text, which it cannot pass.
std::optional<QVariant> to_variant(const Value& value);

/// Figures by name, those that MeshLab passes on.
std::map<std::string, QVariant> returned_values(const Values& values);

/// The same for the log, a line each, text included.
std::vector<std::string> logged_values(const Values& values);

/// The result's figures: score, found (the verdict), pairs and candidates (their numbers), seconds,
/// the mirror's own numbers, of a plane also its reflection matrix, the method's statistics, and
/// the candidates' scores, of planes also their normals and offsets, as vectors.
std::map<std::string, QVariant> returned_values(const Result& result);

/// The same for the log, a line each, text included.
std::vector<std::string> logged_values(const Result& result);

}  // namespace symsurf::meshlab
