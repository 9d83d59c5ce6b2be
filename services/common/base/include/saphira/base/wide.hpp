#pragma once

/// Marks a function that is compiled twice: the faster form is taken where the processor has it.
/// The arithmetic is the same to the bit.
#if defined(__x86_64__) && defined(__OPTIMIZE__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SAPHIRA_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define SAPHIRA_WIDE
#endif
