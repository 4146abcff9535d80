// Runs a fuzz target where there is no libFuzzer, and so without its coverage and its sanitizers:
// on the seeds, then for a while on what random changes make of these. An input that ends the
// target is left in the working folder.
//
//   TARGET SECONDS [FOLDER_OF_SEEDS]
//
// The seconds are those of the full run; there are fewer by default.

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "core/seeds.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

// A target that knows the structure of its input has one.
extern "C" [[gnu::weak]] std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                                             std::size_t most, unsigned seed);

namespace {

using Bytes = std::vector<std::uint8_t>;
using Random = std::minstd_rand;

constexpr std::size_t longest = 4096;
constexpr unsigned most_seconds_a_run = 120;

Random mutations(1);
Bytes running;
std::string finding;

void change(Bytes& bytes, Random& random) {
  const auto below = [&](std::size_t count) { return random() % count; };
  const auto any = [&] { return static_cast<std::uint8_t>(random() >> 8); };
  if (bytes.empty() || below(8) == 0) {
    bytes.resize(below(longest + 1));
    for (std::uint8_t& byte : bytes) byte = any();
    return;
  }
  const auto at = bytes.begin() + static_cast<std::ptrdiff_t>(below(bytes.size()));
  switch (below(4)) {
    case 0:
      *at = any();
      break;
    case 1:
      *at ^= static_cast<std::uint8_t>(1 << below(8));
      break;
    case 2:
      bytes.erase(at, at + static_cast<std::ptrdiff_t>(
                               below(static_cast<std::size_t>(bytes.end() - at)) + 1));
      break;
    default:
      if (bytes.size() < longest) bytes.insert(at, any());
  }
}

// Ends as it would have without, but leaves the input. Calls nothing that a signal may not.
void leave_finding(int signal) {
  const int file = open(finding.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644);
  if (file >= 0) {
    [[maybe_unused]] const auto written = write(file, running.data(), running.size());
    close(file);
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void run(const Bytes& bytes) {
  running = bytes;
  alarm(most_seconds_a_run);
  LLVMFuzzerTestOneInput(running.data(), running.size());
}

std::vector<Bytes> seeds_in(const char* folder) {
  std::vector<Bytes> seeds;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    seeds.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return seeds;
}

}  // namespace

// libFuzzer's mutation of bytes.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most) {
  Bytes bytes(data, data + size);
  change(bytes, mutations);
  bytes.resize(std::min(bytes.size(), most));
  std::copy(bytes.begin(), bytes.end(), data);
  return bytes.size();
}

int main(int argc, char** argv) {
  using Clock = std::chrono::steady_clock;
  const double share = static_cast<double>(symsurf::seeds) / symsurf::seeds_of_the_full_run;
  const double seconds = share * (argc > 1 ? std::atof(argv[1]) : 1);
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  finding = "finding-" + std::filesystem::path(argv[0]).filename().string();
  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGBUS, SIGALRM})
    std::signal(signal, leave_finding);
  const std::vector<Bytes> seeds = argc > 2 ? seeds_in(argv[2]) : std::vector<Bytes>{{}};
  for (const Bytes& seed : seeds) run(seed);
  std::size_t runs = seeds.size();
  Random random(2);
  for (; Clock::now() < end; ++runs) {
    Bytes bytes = seeds[random() % seeds.size()];
    for (std::size_t changes = 1 + random() % 4; changes > 0; --changes) {
      if (!LLVMFuzzerCustomMutator) {
        change(bytes, random);
        continue;
      }
      const std::size_t size = bytes.size();
      bytes.resize(longest);
      bytes.resize(LLVMFuzzerCustomMutator(bytes.data(), std::min(size, longest), longest,
                                           static_cast<unsigned>(random())));
    }
    run(bytes);
  }
  std::printf("%zu runs\n", runs);
}
