#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "cloud/cloud.h"
#include "processes.h"

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

namespace {

enum class Outcome : char { Found, BadInput, BadParameter, Stopped, Failed };

Communicator::Bytes message_of(Outcome outcome, std::span<const std::byte> what) {
  Communicator::Bytes bytes(1 + what.size(), static_cast<std::byte>(outcome));
  std::copy(what.begin(), what.end(), bytes.begin() + 1);
  return bytes;
}

Communicator::Bytes message_of(Outcome outcome, const std::exception& error) {
  return message_of(outcome, std::as_bytes(std::span(std::string_view(error.what()))));
}

// Of a result all but the pairs, which stay in `result`.
Communicator::Bytes outcome_of(const std::function<Result()>& work, Result& result) {
  try {
    result = work();
    return message_of(Outcome::Found, serialize(result));
  } catch (const InvalidInput& error) {
    return message_of(Outcome::BadInput, error);
  } catch (const InvalidParameter& error) {
    return message_of(Outcome::BadParameter, error);
  } catch (const Cancelled& error) {
    return message_of(Outcome::Stopped, error);
  } catch (const std::exception& error) {
    return message_of(Outcome::Failed, error);
  }
}

Result result_from(std::span<const std::byte> bytes) {
  const auto outcome = static_cast<Outcome>(bytes.front());
  const auto what = bytes.subspan(1);
  if (outcome == Outcome::Found) return deserialize(what);
  const std::string message(reinterpret_cast<const char*>(what.data()), what.size());
  switch (outcome) {
    case Outcome::BadInput:
      throw InvalidInput(message);
    case Outcome::BadParameter:
      throw InvalidParameter(message);
    case Outcome::Stopped:
      throw Cancelled();
    default:
      throw std::runtime_error(message);
  }
}

// By rank where each process's items begin, of as many as each has; and their end.
std::vector<Index> begins_of(Index own, const Communicator& processes) {
  std::vector<Index> begins{0};
  for (const std::vector<Index>& count : all_gather(processes, std::vector{own}))
    begins.push_back(begins.back() + count.front());
  return begins;
}

// Room for the rows of all on the root. Throws in every process where there is none.
Points room_on_root(Index count, const Communicator& processes) {
  Points rows;
  char fits = 1;
  try {
    if (processes.rank() == 0) rows.resize(count, 3);
  } catch (const std::bad_alloc&) {
    fits = 0;
  }
  if (!all_gather(processes, std::vector{fits}).front().front())
    throw InvalidInput("the " + std::to_string(count) +
                       " points of all processes do not fit into the memory of the first; this "
                       "method needs all of them in one process");
  return rows;
}

// The rows of all on the root, none on the others.
Points rows_on_root(PointsView own, const std::vector<Index>& begins,
                    const Communicator& processes) {
  const bool is_root = processes.rank() == 0;
  Points all = room_on_root(begins.back(), processes);
  all_to_all<Vector3>(
      processes, [&](int process) { return process == 0 ? own.size() : 0; },
      [&](int process) { return is_root ? begins[process + 1] - begins[process] : 0; },
      [&](int, Index k) { return own[k]; },
      [&](int process, Index k, const Vector3& row) {
        all.row(begins[process] + k) = row.transpose();
      });
  return all;
}

// From the root to the processes that have the points.
void send_back_pairs(Result& result, const std::vector<Index>& begins,
                     const Communicator& processes) {
  struct Pair {
    Vector3 surface_point;
    Index point, partner;
    double residual;
  };
  std::vector<std::vector<Index>> rows(processes.size());  // of the result, by process
  for (Index row = 0; row < result.pairs.rows(); ++row) {
    const auto after = std::upper_bound(begins.begin(), begins.end(), result.pairs(row, 0));
    rows[after - begins.begin() - 1].push_back(row);
  }
  std::vector<Index> counts;
  for (const std::vector<Index>& theirs : rows) counts.push_back(static_cast<Index>(theirs.size()));
  const Index count = all_gather(processes, counts).front()[processes.rank()];

  Result own;
  own.pairs.resize(count, 2);
  own.residuals.resize(count);
  own.surface_points.resize(count, 3);
  all_to_all<Pair>(
      processes, [&](int process) { return counts[process]; },
      [&](int process) { return process == 0 ? count : 0; },
      [&](int process, Index k) {
        const Index row = rows[process][k];
        return Pair{result.surface_points.row(row), result.pairs(row, 0), result.pairs(row, 1),
                    result.residuals[row]};
      },
      [&](int, Index k, const Pair& pair) {
        own.surface_points.row(k) = pair.surface_point.transpose();
        own.pairs.row(k) << pair.point, pair.partner;
        own.residuals[k] = pair.residual;
      });
  result.pairs = std::move(own.pairs);
  result.residuals = std::move(own.residuals);
  result.surface_points = std::move(own.surface_points);
}

}  // namespace

Result run_on_root(PointsView own, PointsView normals, const Communicator& processes,
                   const std::function<Result(PointsView, PointsView)>& run) {
  const std::vector<Index> begins = begins_of(own.size(), processes);
  Result here;
  Communicator::Bytes outcome;
  {
    const Points all = rows_on_root(own, begins, processes);
    const Points all_normals =
        rows_on_root(normals, begins_of(normals.size(), processes), processes);
    if (processes.rank() == 0) outcome = outcome_of([&] { return run(all, all_normals); }, here);
  }
  Result result = result_from(processes.all_gather(outcome).front());
  result.pairs = std::move(here.pairs);
  result.residuals = std::move(here.residuals);
  result.surface_points = std::move(here.surface_points);
  send_back_pairs(result, begins, processes);
  return result;
}

}  // namespace symsurf
