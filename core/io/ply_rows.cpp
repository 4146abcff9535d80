#include "ply_rows.h"

#include <symsurf/context.h>

#include <cstdint>

#include "byte_order.h"

namespace symsurf {

namespace {

std::string truncated(const PlyElement& element, Index row) {
  return "the file is truncated: it ends at row " + std::to_string(row) + " of the " +
         std::to_string(element.count) + " of the element " + in_quotes(element.name);
}

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::Int8:
    case PlyType::UInt8:
      return 1;
    case PlyType::Int16:
    case PlyType::UInt16:
      return 2;
    case PlyType::Float64:
      return 8;
    default:
      return 4;
  }
}

}  // namespace

void PlyTextRows::begin(const PlyElement& element, Index row) {
  if (!text_.next_line()) throw InvalidInput(truncated(element, row));
  is_vertex_ = element.name == "vertex";
  first_line_ = text_.line_number();
}

const char* PlyBinaryRows::take(PlyType type) {
  const std::size_t size = size_of(type);
  if (bytes_.size() < size) throw InvalidInput(truncated(*element_, row_));
  const char* at = bytes_.data();
  bytes_.remove_prefix(size);
  return at;
}

double PlyBinaryRows::number(const PlyProperty& property, PlyType type) {
  const char* at = take(type);
  switch (type) {
    case PlyType::Int8:
      return load<std::int8_t>(at, order_);
    case PlyType::UInt8:
      return load<std::uint8_t>(at, order_);
    case PlyType::Int16:
      return load<std::int16_t>(at, order_);
    case PlyType::UInt16:
      return load<std::uint16_t>(at, order_);
    case PlyType::Int32:
      return load<std::int32_t>(at, order_);
    case PlyType::UInt32:
      return load<std::uint32_t>(at, order_);
    case PlyType::Float32:
      return load<float>(at, order_);
    case PlyType::Float64:
      return load<double>(at, order_);
  }
  fail(property.name + " has no type");
}

void PlyBinaryRows::fail(const std::string& reason) const {
  throw InvalidInput("row " + std::to_string(row_) + " of the element " +
                     in_quotes(element_->name) + ": " + reason);
}

}  // namespace symsurf
