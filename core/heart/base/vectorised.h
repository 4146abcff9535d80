#pragma once

/// For small loops that everything waits for: compiled for AVX2 as well as for the least processor,
/// chosen as the program starts. The bits are the same, as products and sums are not fused.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define SYMSURF_VECTORISED __attribute__((target_clones("avx2", "default")))
#else
#define SYMSURF_VECTORISED
#endif
