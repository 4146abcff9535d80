#include "detection/run_on_root.h"

#include <symsurf/context.h>

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "detection/serialize.h"
#include "distributed/collectives.h"

namespace symsurf {

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
