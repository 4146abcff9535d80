#include <algorithm>
#include <array>
#include <random>
#include <string>
#include <vector>

#include "reader.h"

// A header is a list of lines of words: mutations exchange, copy, drop and swap those. What a
// mutation of bytes makes of a header is mostly a word that PLY does not have.

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

using Words = std::vector<std::string>;

constexpr std::string_view end_of_header = "end_header\n";

constexpr std::array<std::string_view, 34> vocabulary{
    "ascii", "binary_little_endian", "binary_big_endian", "1.0", "vertex", "face", "edge", "x", "y",
    "z", "nx", "ny", "nz", "vertex_indices", "vertex_index", "list", "char", "uchar", "int16",
    "ushort", "int", "uint32", "float", "double", "0", "1", "3", "255", "100000",
    // Counts whose sums and multiples a 64-bit integer does not hold.
    "6666661000000000000", "9223372036854775807", "18446744073709551616", "-1", "0.5"};

constexpr std::array<std::string_view, 5> lines{
    "element vertex 3", "element face 1", "property double x",
    "property list uchar int vertex_indices", "comment"};

std::vector<Words> header_lines(std::string_view header) {
  std::vector<Words> parsed(1, Words(1));
  for (const char c : header) {
    if (c == '\n')
      parsed.push_back(Words(1));
    else if (c == ' ')
      parsed.back().emplace_back();
    else
      parsed.back().back() += c;
  }
  return parsed;
}

std::string text_of(const std::vector<Words>& parsed) {
  std::string text;
  for (std::size_t i = 0; i < parsed.size(); ++i) {
    if (i > 0) text += '\n';
    for (std::size_t k = 0; k < parsed[i].size(); ++k) {
      if (k > 0) text += ' ';
      text += parsed[i][k];
    }
  }
  return text;
}

std::string mutated(std::string_view header, std::minstd_rand& random) {
  const auto below = [&](std::size_t count) { return random() % count; };
  std::vector<Words> parsed = header_lines(header);
  const std::size_t at = below(parsed.size());
  switch (below(6)) {
    case 0:
      parsed.insert(parsed.begin() + at, parsed[below(parsed.size())]);
      break;
    case 1:
      if (parsed.size() > 1) parsed.erase(parsed.begin() + at);
      break;
    case 2:
      std::swap(parsed[at], parsed[below(parsed.size())]);
      break;
    case 3:
      parsed.insert(parsed.begin() + at, header_lines(lines[below(lines.size())])[0]);
      break;
    default:
      parsed[at][below(parsed[at].size())] = vocabulary[below(vocabulary.size())];
  }
  return text_of(parsed);
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  std::minstd_rand random(seed);
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  const std::size_t end = content.find(end_of_header);
  if (end == content.npos || random() % 2 == 0) return LLVMFuzzerMutate(data, size, most);
  const std::string whole = mutated(content.substr(0, end), random).append(content.substr(end));
  const std::size_t kept = std::min(whole.size(), most);
  std::copy_n(whole.begin(), kept, data);
  return kept;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  symsurf::fuzz_reader(symsurf::read_ply, data, size);
  return 0;
}
