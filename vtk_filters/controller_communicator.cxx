#include "controller_communicator.h"

#include <symsurf/context.h>

#include <cstring>
#include <new>
#include <numeric>
#include <stdexcept>

#include "mpi_barrier.h"

namespace {

constexpr int message_tag = 7120;

const char* chars(const std::byte* bytes) { return reinterpret_cast<const char*>(bytes); }
char* chars(std::byte* bytes) { return reinterpret_cast<char*>(bytes); }

// VTK's calls return 0 where they fail, as beyond 2 GB.
void require_exchange(int succeeded) {
  if (!succeeded) throw std::runtime_error("the processes cannot exchange their data");
}

}  // namespace

std::vector<symsurf::Communicator::Bytes> ControllerCommunicator::all_gather(
    std::span<const std::byte> mine) const {
  const auto length = static_cast<vtkIdType>(mine.size());
  std::vector<vtkIdType> lengths(size()), offsets(size());
  barrier(controller_);
  require_exchange(controller_->AllGather(&length, lengths.data(), 1));
  std::exclusive_scan(lengths.begin(), lengths.end(), offsets.begin(), vtkIdType{0});
  Bytes all(offsets.back() + lengths.back());
  require_exchange(controller_->AllGatherV(chars(mine.data()), chars(all.data()), length,
                                           lengths.data(), offsets.data()));
  std::vector<Bytes> parts;
  for (int rank = 0; rank < size(); ++rank) {
    const auto begin = all.begin() + offsets[rank];
    parts.emplace_back(begin, begin + lengths[rank]);
  }
  return parts;
}

// The lower rank sends first: else both would wait for the other to receive.
symsurf::Communicator::Bytes ControllerCommunicator::send_recv(
    int other, std::span<const std::byte> mine) const {
  const auto send = [&] {
    const auto length = static_cast<vtkIdType>(mine.size());
    require_exchange(controller_->Send(&length, 1, other, message_tag));
    if (length > 0)
      require_exchange(controller_->Send(chars(mine.data()), length, other, message_tag));
  };
  Bytes theirs;
  const auto receive = [&] {
    vtkIdType length = 0;
    require_exchange(controller_->Receive(&length, 1, other, message_tag));
    theirs.resize(length);
    if (length > 0)
      require_exchange(controller_->Receive(chars(theirs.data()), length, other, message_tag));
  };
  signal_and_wait(controller_, other, other);
  if (rank() < other) {
    send();
    receive();
  } else {
    receive();
    send();
  }
  return theirs;
}

void together(const ControllerCommunicator& processes, const std::function<void()>& part) {
  if (processes.size() == 1) return part();
  std::string problem;
  try {
    part();
  } catch (const symsurf::InvalidInput& error) {
    problem = error.what();
  } catch (const std::bad_alloc&) {
    problem = "a process has too little memory for its points";
  }
  for (const auto& theirs : processes.all_gather(std::as_bytes(std::span(problem))))
    if (!theirs.empty())
      throw symsurf::InvalidInput(std::string(chars(theirs.data()), theirs.size()));
}

bool are_elsewhere(const ControllerCommunicator& processes, symsurf::Index own,
                   const std::string& what) {
  if (processes.size() == 1) return false;
  int with_points = 0;
  for (const auto& theirs : processes.all_gather(std::as_bytes(std::span(&own, 1)))) {
    symsurf::Index count;
    std::memcpy(&count, theirs.data(), sizeof count);
    with_points += count > 0;
  }
  if (with_points > 1)
    throw symsurf::InvalidInput(std::to_string(with_points) + " processes share out the points; " +
                                what + " needs all of them in one: aggregate the data set first");
  return with_points == 1 && own == 0;
}
