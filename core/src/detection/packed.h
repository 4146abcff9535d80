#pragma once

#include <symsurf/communicator.h>
#include <symsurf/result.h>

#include <span>

namespace symsurf {

/// A result but for its pairs and all that belongs to them, as bytes for other processes.
Communicator::Bytes packed(const Result& result);

/// The result that packed() was given: the same numbers, to the bit.
Result unpacked(std::span<const std::byte> bytes);

}  // namespace symsurf
