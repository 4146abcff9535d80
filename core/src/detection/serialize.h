#pragma once

#include <symsurf/context.h>
#include <symsurf/detect.h>

#include <span>

namespace symsurf {

/// A result but for its pairs and all that belongs to them, as bytes for other processes.
Communicator::Bytes serialize(const Result& result);

/// The result that serialize() was given: the same numbers, to the bit.
Result deserialize(std::span<const std::byte> bytes);

}  // namespace symsurf
