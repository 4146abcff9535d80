#pragma once

#include <cstdint>

/// For small loops that everything waits for: compiled for AVX2 as well as for the least processor,
/// chosen as the program starts. The bits are the same, as products and sums are not fused.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define SYMSURF_VECTORISED __attribute__((target_clones("avx2", "default")))
#else
#define SYMSURF_VECTORISED
#endif

namespace symsurf {

/// Numbers side by side in a vector register, anywhere in memory (an extension of GCC and Clang).
/// Compilers make such of plain loops, but of those that compare and choose they often do not.
typedef double Doubles __attribute__((vector_size(4 * sizeof(double)), aligned(8), may_alias));
typedef float Floats __attribute__((vector_size(8 * sizeof(float)), aligned(4), may_alias));
typedef std::int32_t Ints __attribute__((vector_size(8 * 4), aligned(4), may_alias));

constexpr int doubles_wide = 4, floats_wide = 8;

}  // namespace symsurf
