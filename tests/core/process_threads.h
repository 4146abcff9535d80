#pragma once

#include <symsurf/context.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace symsurf {

/// Threads that share nothing but messages, as processes do.
class ProcessThreads {
 public:
  explicit ProcessThreads(int count) : count_(count) {}

  /// Runs body(communicator) on every one of them, to the end of all.
  void run(const std::function<void(const Communicator&)>& body) {
    std::vector<std::thread> threads;
    for (int rank = 0; rank < count_; ++rank)
      threads.emplace_back([this, rank, &body] { body(Process(*this, rank)); });
    for (std::thread& thread : threads) thread.join();
  }

 private:
  using Bytes = Communicator::Bytes;

  class Process : public Communicator {
   public:
    Process(ProcessThreads& all, int rank) : all_(all), rank_(rank) {}

    int rank() const override { return rank_; }
    int size() const override { return all_.count_; }
    std::vector<Bytes> all_gather(std::span<const std::byte> mine) const override {
      for (int to = 0; to < size(); ++to) all_.send(rank_, to, {mine.begin(), mine.end()});
      std::vector<Bytes> parts;
      for (int from = 0; from < size(); ++from) parts.push_back(all_.receive(from, rank_));
      return parts;
    }
    Bytes send_recv(int other, std::span<const std::byte> mine) const override {
      all_.send(rank_, other, {mine.begin(), mine.end()});
      return all_.receive(other, rank_);
    }

   private:
    ProcessThreads& all_;
    int rank_;
  };

  void send(int from, int to, Bytes message) {
    const std::scoped_lock lock(mutex_);
    letters_[{from, to}].push_back(std::move(message));
    arrived_.notify_all();
  }

  Bytes receive(int from, int to) {
    std::unique_lock lock(mutex_);
    std::deque<Bytes>& letters = letters_[{from, to}];
    arrived_.wait(lock, [&] { return !letters.empty(); });
    Bytes message = std::move(letters.front());
    letters.pop_front();
    return message;
  }

  int count_;
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::map<std::pair<int, int>, std::deque<Bytes>> letters_;
};

}  // namespace symsurf
