#include "detection/serialize.h"

#include <symsurf/mirrors.h>

#include <cstring>
#include <type_traits>
#include <utility>

#include "cloud/footprint.h"

namespace symsurf {

namespace {

class Writer {
 public:
  Communicator::Bytes bytes;

  template <typename T>
  requires std::is_arithmetic_v<T>
  void put(T number) { put_items(&number, 1); }

  void put(const std::string& text) {
    put(text.size());
    put_items(text.data(), text.size());
  }

  void put(const Vector3& vector) { put_items(vector.data(), 3); }

  void put(const Eigen::MatrixXd& matrix) {
    put(matrix.rows());
    put(matrix.cols());
    put_items(matrix.data(), static_cast<std::size_t>(matrix.size()));
  }

  void put(const Values& values) {
    put(values.size());
    for (const auto& [name, value] : values) {
      put(name);
      put(value.index());
      std::visit([this](const auto& held) { put(held); }, value);
    }
  }

  void put(const Result& result) {
    put(result.method);
    put(result.mirror != nullptr);
    if (result.mirror) {
      put(std::string(result.mirror->kind()));
      put(result.mirror->numbers());
    }
    put(result.score);
    put(result.parameters);
    put(result.statistics);
    put(result.seconds);
    put(result.candidates.size());
    for (const Result& candidate : result.candidates) put(candidate);
  }

 private:
  template <typename T>
  void put_items(const T* items, std::size_t count) {
    const auto raw = std::as_bytes(std::span(items, count));
    bytes.insert(bytes.end(), raw.begin(), raw.end());
  }
};

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <typename T>
  requires std::is_arithmetic_v<T>
  void take(T& number) { take_items(&number, 1); }

  void take(std::string& text) {
    text.resize(taken<std::size_t>());
    take_items(text.data(), text.size());
  }

  void take(Vector3& vector) { take_items(vector.data(), 3); }

  void take(Eigen::MatrixXd& matrix) {
    const Index rows = taken<Index>();
    matrix.resize(rows, taken<Index>());
    take_items(matrix.data(), static_cast<std::size_t>(matrix.size()));
  }

  void take(Values& values) {
    for (std::size_t left = taken<std::size_t>(); left > 0; --left) {
      const std::string name = taken<std::string>();
      values.emplace(name, taken_value<0>(taken<std::size_t>()));
    }
  }

  void take(Result& result) {
    take(result.method);
    if (taken<bool>()) {
      const std::string kind = taken<std::string>();
      result.mirror = make_mirror(kind, taken<Values>());
    }
    take(result.score);
    take(result.parameters);
    take(result.statistics);
    take(result.seconds);
    result.candidates.resize(taken<std::size_t>());
    for (Result& candidate : result.candidates) take(candidate);
  }

 private:
  template <typename T>
  T taken() {
    T item{};
    take(item);
    return item;
  }

  template <std::size_t type>
  Value taken_value(std::size_t held) {
    if constexpr (type + 1 < std::variant_size_v<Value>)
      if (held != type) return taken_value<type + 1>(held);
    return taken<std::variant_alternative_t<type, Value>>();
  }

  template <typename T>
  void take_items(T* items, std::size_t count) {
    const std::size_t size = count * sizeof(T);
    if (size > 0) std::memcpy(items, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
  }

  std::span<const std::byte> bytes_;
};

// All mirrors of a result stand for the same object: its footprint goes once.
PointsView footprint_of(const Result& result) {
  if (result.mirror) return result.mirror->footprint();
  for (const Result& candidate : result.candidates)
    if (candidate.mirror) return candidate.mirror->footprint();
  return {};
}

}  // namespace

Communicator::Bytes serialize(const Result& result) {
  Writer writer;
  writer.put(result);
  writer.put(Eigen::MatrixXd(footprint_of(result).matrix()));
  return std::move(writer.bytes);
}

Result deserialize(std::span<const std::byte> bytes) {
  Reader reader(bytes);
  Result result;
  Eigen::MatrixXd footprint;
  reader.take(result);
  reader.take(footprint);
  set_footprint(result, Points(footprint));
  return result;
}

}  // namespace symsurf
